// Hidden forks: two strands that meet at the edge of an occluder look like one that turns back
// there. Which of them goes on where is for the search to say.
#pragma once

#include "path/cover.hpp"
#include "path/graph.hpp"

namespace flowdlo::path {

/// Puts a node where a segment turns sharply with an occluder outside of the turn.
void split_at_hidden_forks(Graph& graph, const Cover& cover);

}  // namespace flowdlo::path
