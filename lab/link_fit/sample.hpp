// LinkSample: a scene's strands as the network of path/link_network is fitted to them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "link_fit/labels.hpp"
#include "path/link_network.hpp"

namespace flowdlo::lab {

struct LinkSample {
  /// An end, as one at which its rope may stop.
  struct End {
    int partner = kUnknown;
    float by_energy = 0;  ///< what it costs by path/energy.hpp
    path::LinkFeatures features{};
  };
  /// Two ends, the lower one first, that may be linked; one of them at least is known.
  struct Link {
    int a = 0;
    int b = 0;
    float by_energy = 0;
    path::LinkFeatures forth{};  ///< from a to b, and from b to a
    path::LinkFeatures back{};
  };

  std::uint64_t index = 0;
  std::string kind;  ///< of the scene and its reading
  std::vector<End> ends;
  std::vector<Link> links;
};

/// The links that the engine asks about, and the right ones.
[[nodiscard]] LinkSample sample_of(const Labelled& labelled);

}  // namespace flowdlo::lab
