// The strand field's network on FlowDLO's back ends, libtorch and ONNX Runtime. A problem must
// outlive its peers.
#pragma once

#include <filesystem>
#include <memory>

#include "field/network.hpp"
#include "peers/field_problem.hpp"

namespace flowdlo::peers {

/// `device` names the back end. Fails as field::Network::create does.
[[nodiscard]] Result<std::unique_ptr<FieldPeer>> flowdlo_field_peer(
    const FieldProblem& problem, const std::string& device,
    const field::ProgramFactory& make_program);

/// Every place of the region is computed: its convolutions know no blocks. `channels_last`: images
/// lie in memory pixel by pixel, which some of its kernels like better. Sets libtorch's and its
/// BLAS' number of threads for the whole process.
[[nodiscard]] std::unique_ptr<FieldPeer> torch_field_peer(const FieldProblem& problem,
                                                          bool channels_last);

/// Likewise. Fails with kIo when `library` is no ONNX Runtime.
[[nodiscard]] Result<std::unique_ptr<FieldPeer>> onnx_field_peer(
    const FieldProblem& problem, const std::filesystem::path& library);

}  // namespace flowdlo::peers
