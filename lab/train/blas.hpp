// Blas: which linear algebra library libtorch multiplies with; Debian's default is 35 times slower.
#pragma once

#include <string>

namespace flowdlo::train {

struct Blas {
  std::string name;
  bool slow = false;  ///< the reference BLAS
};

[[nodiscard]] Blas find_blas();

/// Threads of the BLAS itself, where it has its own; libtorch's number does not reach it.
void set_blas_threads(int threads);

}  // namespace flowdlo::train
