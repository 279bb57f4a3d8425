// What quality fast stands for is measured after training: it is set in the finished file.
#include "flowdlo/weights.hpp"
#include "guard/guarded.hpp"
#include "weights/fdw.hpp"

namespace flowdlo {
namespace {

Result<void> rewrite(const std::filesystem::path& weights, int steps, int draws,
                     const std::filesystem::path& output) {
  auto file = weights::read_fdw(weights);
  if (!file) return file.error();
  file->weights.metadata.fast_steps = steps;
  file->weights.metadata.fast_draws = draws;
  return weights::write_fdw(file->weights, file->types, output);
}

}  // namespace

Result<void> set_fast_quality(const std::filesystem::path& weights, int steps, int draws,
                              const std::filesystem::path& output) {
  return guard::guarded("set_fast_quality", [&] { return rewrite(weights, steps, draws, output); });
}

}  // namespace flowdlo
