#include "train/blas.hpp"

#include <dlfcn.h>

#include <torch/torch.h>

namespace flowdlo::train {
namespace {

template <class Function>
Function* symbol(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

Blas find_blas() {
  if (at::hasMKL()) return {"MKL", false};
  if (auto* config = symbol<char*()>("openblas_get_config")) return {config(), false};
  if (symbol<void()>("bli_init") != nullptr) return {"BLIS", false};
  if (auto* sgemm = symbol<void()>("sgemm_")) {
    Dl_info info{};
    const bool found = dladdr(reinterpret_cast<void*>(sgemm), &info) != 0;
    return {found && info.dli_fname != nullptr ? info.dli_fname : "reference BLAS", true};
  }
  return {"libtorch's own", false};
}

void set_blas_threads(int threads) {
  if (auto* set = symbol<void(int)>("openblas_set_num_threads")) set(threads);
}

}  // namespace flowdlo::train
