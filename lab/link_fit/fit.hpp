// LinkFit: the network that says what links and stops cost (path/link_network.hpp), fitted to
// scenes with truth.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "link_fit/sample.hpp"
#include "weights/link_weights.hpp"

namespace flowdlo::lab {

/// So that what each choice really is becomes likely among all that it might have been, and each
/// link and stop as likely as it is right. `rounds` over all samples; the same for the same
/// samples. Expects one sample at least.
[[nodiscard]] weights::LinkWeights fit_links(const std::vector<LinkSample>& samples, int rounds);

/// Of the choices at the ends of strands.
struct LinkQuality {
  std::size_t choices = 0;
  double unlikely = 0;  ///< mean negative logarithm of how likely the right option is
  double wrong = 0;     ///< share of choices of which another is likelier
};

/// Of what path/energy.hpp says; null weights.
[[nodiscard]] LinkQuality quality_of(std::span<const LinkSample> samples,
                                     const weights::LinkWeights* weights);

}  // namespace flowdlo::lab
