// LinkNetwork: how likely a rope goes on from one strand's end to another, or ends there, as a
// small network says it: fitted to scenes with truth by `flowdlo-lab link-fit`, for the strand
// field whose file it is in.
#pragma once

#include <array>
#include <cstddef>

#include "path/link_evidence.hpp"
#include "weights/bent_network.hpp"
#include "weights/link_weights.hpp"

namespace flowdlo::path {

/// One of both ends of a link, looking to the other.
struct LinkSide {
  EndFeatures end;
  SideFeatures side;
};

/// What the network is told of going on from one end to another, or, all else zero, of ending
/// there: 1; 1 where nothing follows; the pair; both sides, this end's first.
inline constexpr std::size_t kLinkFeatures =
    2 + kPairFeatures + 2 * (std::size_t{kSideFeatures} + kEndFeatures);
using LinkFeatures = std::array<float, kLinkFeatures>;

[[nodiscard]] LinkFeatures link_features(const PairFeatures& pair, const LinkSide& from,
                                         const LinkSide& to);
[[nodiscard]] LinkFeatures stop_features(const EndFeatures& end);

/// Energies are negative logarithms of likelihoods. Borrows the weights.
class LinkNetwork {
 public:
  explicit LinkNetwork(const weights::LinkWeights& weights) : against_(weights) {}

  /// The same whichever end comes first.
  [[nodiscard]] float link(const PairFeatures& pair, const LinkSide& a, const LinkSide& b) const {
    return energy(link_features(pair, a, b), link_features(pair, b, a));
  }
  [[nodiscard]] float stop(const EndFeatures& end) const { return energy(stop_features(end)); }

  /// Of a stop, and of a link that is told both ways.
  [[nodiscard]] float energy(const LinkFeatures& stop) const;
  [[nodiscard]] float energy(const LinkFeatures& forth, const LinkFeatures& back) const;

 private:
  weights::BentNetwork against_;  // log odds against it
};

}  // namespace flowdlo::path
