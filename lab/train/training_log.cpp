#include "train/training_log.hpp"

#include <fmt/format.h>

#include <string>

namespace flowdlo::train {
namespace {

constexpr const char* kStepsHeader =
    "step,total,primary,prior,spacing,bending,harm,sigma,rate,gradient_norm,records_per_s,records";
constexpr const char* kValidationHeader =
    "step,group,records,prior_cm,model_cm,ratio,prior_median_cm,model_median_cm,prior_over_2cm,"
    "model_over_2cm,harmed,flips";

/// The rows of an earlier run up to `step`, header included.
std::string kept(const std::filesystem::path& file, const std::string& header, std::int64_t step) {
  std::string text = header + "\n";
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    const char* const first = line.c_str();
    char* end = nullptr;
    const long long number = std::strtoll(first, &end, 10);
    if (end != first && *end == ',' && number <= step) text += line + "\n";
  }
  return text;
}

std::ofstream reopened(const std::filesystem::path& file, const std::string& header,
                       std::int64_t step) {
  const std::string text = kept(file, header, step);
  std::ofstream stream(file, std::ios::trunc);
  stream << text << std::flush;
  return stream;
}

}  // namespace

Result<TrainingLog> TrainingLog::open(const std::filesystem::path& folder, std::int64_t step) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  TrainingLog log;
  log.steps_ = reopened(folder / "steps.csv", kStepsHeader, step);
  log.validation_ = reopened(folder / "validation.csv", kValidationHeader, step);
  if (log.steps_ && log.validation_) return log;
  return Error{ErrorCode::kIo,
               fmt::format("{}: expected a writable folder; check the path", folder.string())};
}

void TrainingLog::add(const StepReport& r) {
  steps_ << fmt::format(
                "{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.2f},{}\n",
                r.step, r.total, r.primary, r.prior, r.spacing, r.bending, r.harm, r.sigma, r.rate,
                r.gradient_norm, r.records_per_s, r.records)
         << std::flush;
}

void TrainingLog::add(std::int64_t step, const std::vector<GroupErrors>& groups) {
  for (const GroupErrors& g : groups) {
    validation_ << fmt::format(
        "{},{},{},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{}\n", step, g.group,
        g.records, g.prior_cm, g.model_cm, g.ratio(), g.prior_median_cm, g.model_median_cm,
        g.prior_over, g.model_over, g.harmed, g.flips);
  }
  validation_ << std::flush;
}

}  // namespace flowdlo::train
