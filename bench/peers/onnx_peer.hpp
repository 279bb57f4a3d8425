// ONNX Runtime on the CPU as one of the peers.
#pragma once

#include <filesystem>
#include <memory>

#include "peers/problem.hpp"

namespace flowdlo::peers {

/// Fails with kIo when `library` is no ONNX Runtime. `problem` must outlive the peer.
[[nodiscard]] Result<std::unique_ptr<Peer>> onnx_peer(const Problem& problem,
                                                      const std::filesystem::path& library);

}  // namespace flowdlo::peers
