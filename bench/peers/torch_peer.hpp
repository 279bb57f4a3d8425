// libtorch on the CPU, with the model of lab/train, as one of the peers.
#pragma once

#include <memory>

#include "peers/problem.hpp"

namespace flowdlo::peers {

/// Sets libtorch's and its BLAS' number of threads for the whole process.
[[nodiscard]] std::unique_ptr<Peer> torch_peer(const Problem& problem);

}  // namespace flowdlo::peers
