// Contacts: where one strand of the rope passes over another.
#pragma once

#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// Stations, both ends included.
struct Stretch {
  int first = 0;
  int last = 0;

  [[nodiscard]] bool holds(int station) const { return first <= station && station <= last; }
};

/// Two stretches of one rope whose axes run within half a width of each other in the image.
struct Contact {
  Stretch early;  ///< the one the path visits first
  Stretch late;
};

/// In the order of their early stretches. Strands that overlap over a long way make several
/// contacts, about two widths long.
[[nodiscard]] std::vector<Contact> find_contacts(const Strip& strip);

}  // namespace flowdlo::prior
