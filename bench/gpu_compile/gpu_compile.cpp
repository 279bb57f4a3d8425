// GPUs that are not there: every kernel that a device may get, compiled by Mesa's RADV for families
// of Radeons, what its compiler says of each, and what a frame would take by that. Nothing runs.
//
//   gpu_compile [--families LIST] [--all] [--weights FILE]
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "gpu_compile/absent_gpu.hpp"
#include "gpu_compile/estimate.hpp"
#include "vulkan/gemm_candidates.hpp"

namespace flowdlo::gpu_compile {
namespace {

// One or two for each generation of instructions, as RADV of Mesa 22.3 to 25 knows them. Older ones
// ("tahiti", "hawaii") may be asked for: they need the program clrxdisasm for loops to be found.
const std::vector<std::string> kFamilies{"polaris10", "vega10", "vega20",  "renoir",
                                         "navi10",    "navi21", "vangogh", "gfx1036",
                                         "gfx1100",   "navi31", "gfx1200"};

struct Options {
  std::vector<std::string> families = kFamilies;
  std::string family;  // of a child
  std::filesystem::path weights = FLOWDLO_WEIGHTS_FILE;
  bool all = false;
};

/// A family with one choice of lanes, every kernel that it may be given, once.
struct Compiled {
  std::shared_ptr<vulkan::Device> device;
  std::map<std::string, CompiledKernel> kernels;  // by name
};

Result<std::vector<CompiledKernel>> compile(Compiled& compiled,
                                            const std::vector<vulkan::KernelSpec>& specs) {
  auto kernels = compiled.device->kernels(specs);
  if (!kernels) return kernels.error();
  std::vector<CompiledKernel> figures;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto known = compiled.kernels.find(specs[i].name());
    if (known != compiled.kernels.end()) {
      figures.push_back(known->second);
      continue;
    }
    auto asked = figures_of(*compiled.device, specs[i], *(*kernels)[i]);
    if (!asked) return asked.error();
    figures.push_back(*asked);
    compiled.kernels.emplace(specs[i].name(), *std::move(asked));
  }
  return figures;
}

void print_kernels(const Compiled& compiled) {
  std::printf(
      "| kernel and constants | lanes | VGPRs | SGPRs | spilled | scratch | LDS, bytes | code, "
      "bytes "
      "| waves a SIMD | cycles alone | cycles of 64 "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, kernel] : compiled.kernels) {
    std::printf("| %s | %d | %d | %d | %d | %d | %d | %d | %d | %.0f | %.0f |\n", name.c_str(),
                kernel.subgroup, kernel.vgprs, kernel.sgprs, kernel.spilled, kernel.scratch_bytes,
                kernel.lds_bytes, kernel.code_bytes, kernel.waves, kernel.latency,
                kernel.cycles_of_64);
  }
}

/// Most of each figure over all kernels of one shader, fewest of the waves.
void print_summary(const Compiled& compiled) {
  std::map<std::string, std::vector<const CompiledKernel*>> shaders;
  for (const auto& [name, kernel] : compiled.kernels) {
    shaders[name.substr(0, name.find(' '))].push_back(&kernel);
  }
  std::printf(
      "| shader | kernels | VGPRs | SGPRs | spilled | scratch | LDS, bytes | code, bytes | waves a "
      "SIMD |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [shader, kernels] : shaders) {
    CompiledKernel most = *kernels.front();
    for (const CompiledKernel* kernel : kernels) {
      most.vgprs = std::max(most.vgprs, kernel->vgprs);
      most.sgprs = std::max(most.sgprs, kernel->sgprs);
      most.spilled = std::max(most.spilled, kernel->spilled);
      most.scratch_bytes = std::max(most.scratch_bytes, kernel->scratch_bytes);
      most.lds_bytes = std::max(most.lds_bytes, kernel->lds_bytes);
      most.code_bytes = std::max(most.code_bytes, kernel->code_bytes);
      most.waves = std::min(most.waves, kernel->waves);
    }
    std::printf("| %s | %zu | %d | %d | %d | %d | %d | %d | %d |\n", shader.c_str(), kernels.size(),
                most.vgprs, most.sgprs, most.spilled, most.scratch_bytes, most.lds_bytes,
                most.code_bytes, most.waves);
  }
}

void print_share(const std::string& what, const char* part, const Share& share) {
  if (share.dispatches == 0) return;
  const std::string limit = share.limit_ms > 0 ? fmt::format("{:.3f}", share.limit_ms) : "-";
  const std::string ratio =
      share.limit_ms > 0 ? fmt::format("{:.2f}", share.full_ms / share.limit_ms) : "-";
  std::printf("| %s | %s | %d | %s | %.3f | %s | %.3f |\n", what.c_str(), part, share.dispatches,
              limit.c_str(), share.full_ms, ratio.c_str(), share.dispatched_ms);
}

void print_estimate(const std::string& what, const FrameEstimate& estimate) {
  print_share(what, "dense layers", estimate.dense);
  print_share(what, "attention", estimate.attention);
  print_share(what, "convolutions", estimate.convolution);
  print_share(what, "visible points", estimate.visible_points);
  print_share(what, "the rest", estimate.rest);
  std::printf("| %s | all | | | %.3f | | %.3f |\n", what.c_str(), estimate.full_ms(),
              estimate.dispatched_ms());
}

/// Records, compiles and prints one family with one choice of lanes.
Result<void> look_at(const Options& options, int lanes) {
  auto device = open_absent_gpu(options.family, lanes);
  if (!device) return device.error();
  if ((*device)->facts().lanes != lanes) return {};  // it has the other number alone
  Compiled compiled{*std::move(device), {}};
  auto loaded = weights::load(options.weights);
  if (!loaded) return loaded.error();
  const auto model = std::make_shared<const weights::Weights>(*std::move(loaded));
  const auto field = std::make_shared<const weights::FieldWeights>(weights::seeded_field({}, 1));
  const int fast_steps = std::max(model->metadata.fast_steps, 1);
  const int fast_draws = std::max(model->metadata.fast_draws, 1);

  const auto known = std::find_if(cards().begin(), cards().end(),
                                  [&](const Card& card) { return card.family == options.family; });
  std::vector<std::pair<std::string, FrameEstimate>> estimates;
  for (const vulkan::GemmChoice& gemm : vulkan::gemm_candidates(compiled.device->facts())) {
    const auto consider = [&](const std::string& what,
                              const Result<FrameWork>& work) -> Result<void> {
      if (!work) return work.error();
      const auto kernels = compile(compiled, work->kernels);
      if (!kernels) return kernels.error();
      if (known == cards().end()) return {};
      estimates.emplace_back(fmt::format("{}, {}", what, name_of(gemm)),
                             estimate(*work, *kernels, *known));
      return {};
    };
    auto done = consider("D = 4, K = 10", model_work(compiled.device, gemm, model, 4, 10));
    if (done) {
      done = consider(fmt::format("fast: D = {}, K = {}", fast_draws, fast_steps),
                      model_work(compiled.device, gemm, model, fast_draws, fast_steps));
    }
    if (done) done = consider("strand field", field_work(compiled.device, gemm, field));
    if (!done) return done;
  }
  const vulkan::PhysicalDevice& facts = compiled.device->facts();
  std::printf("\n## %s, %s, subgroups of %d\n\n", facts.report.name.c_str(),
              facts.report.driver.c_str(), facts.lanes);
  options.all ? print_kernels(compiled) : print_summary(compiled);
  if (estimates.empty()) return {};
  std::printf(
      "\n%s, %d units at %.2f GHz; estimated ms, neither launches nor waits in it:\n\n"
      "| what, dense layers by | part | dispatches | FLOP limit | full | full / limit | as "
      "dispatched "
      "|\n|---|---|---|---|---|---|---|\n",
      known->name.c_str(), known->compute_units, known->clock_ghz);
  for (const auto& [what, estimated] : estimates) print_estimate(what, estimated);
  return {};
}

/// A child's part: exit status 0 once everything is printed.
int look_at_family(const Options& options) {
  for (const int lanes : {32, 64}) {
    const auto done = look_at(options, lanes);
    if (!done) {
      std::fprintf(stderr, "%s: %s\n", options.family.c_str(), done.error().message.c_str());
      return 1;
    }
  }
  return 0;
}

/// What became of each family, in a process of its own: RADV ends one that asks for what it does
/// not know, and a compiler may crash.
int look_at_families(const Options& options) {
  std::string faults;
  for (const std::string& family : options.families) {
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
      std::vector<std::string> words{"gpu_compile", "--family", family, "--weights",
                                     options.weights.string()};
      if (options.all) words.emplace_back("--all");
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execv("/proc/self/exe", arguments.data());
      ::_exit(127);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child) return 1;
    if (WIFSIGNALED(status)) {
      faults += fmt::format("{}: the driver ended it with signal {}\n", family, WTERMSIG(status));
    } else if (WEXITSTATUS(status) != 0) {
      faults += fmt::format("{}: not compiled, as said above\n", family);
    }
  }
  if (!faults.empty()) std::printf("\n%s", faults.c_str());
  return 0;
}

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app{"Compiles every kernel for Radeons that are not there"};
  app.add_option("--families", options.families, "as RADV names them")->delimiter(',');
  app.add_option("--family", options.family, "this one, in this process");
  app.add_option("--weights", options.weights, "the model whose frame is recorded");
  app.add_flag("--all", options.all, "a row for each kernel in place of one for each shader");
  CLI11_PARSE(app, argc, argv);
  if (radv_library().empty()) {
    std::printf("skipped: RADV is not installed (Debian and Ubuntu: mesa-vulkan-drivers)\n");
    return 0;
  }
  return options.family.empty() ? look_at_families(options) : look_at_family(options);
}

}  // namespace
}  // namespace flowdlo::gpu_compile

int main(int argc, char** argv) { return flowdlo::gpu_compile::main_of(argc, argv); }
