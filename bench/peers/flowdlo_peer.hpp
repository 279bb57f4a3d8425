// FlowDLO's CPU back end as one of the peers.
#pragma once

#include <memory>

#include "peers/problem.hpp"

namespace flowdlo::peers {

/// `problem` must outlive the peer.
[[nodiscard]] std::unique_ptr<Peer> flowdlo_peer(const Problem& problem);

}  // namespace flowdlo::peers
