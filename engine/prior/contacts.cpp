#include "prior/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flowdlo::prior {
namespace {

constexpr float kNearWidths = 0.5F;  // between the axes
constexpr float kLongWidths = 2.0F;
constexpr float kGapWidths = 0.5F;  // between the stations of one contact

bool near(const Stretch& stretch, int station, int gap) {
  return station >= stretch.first - gap && station <= stretch.last + gap;
}

void extend(Stretch& stretch, int station) {
  stretch.first = std::min(stretch.first, station);
  stretch.last = std::max(stretch.last, station);
}

}  // namespace

std::vector<Contact> find_contacts(const Strip& strip) {
  const auto stations_of = [&](float widths) {
    return std::max(2, static_cast<int>(widths * strip.width_px / std::max(strip.step_px, 1e-3F)));
  };
  const int longest = stations_of(kLongWidths);
  const int gap = stations_of(kGapWidths);
  std::vector<Contact> contacts;
  for (int i = 0; i < static_cast<int>(strip.stations.size()); ++i) {
    const int other = strip.neighbour[static_cast<std::size_t>(i)];
    if (other < 0) continue;
    const auto& here = strip.stations[static_cast<std::size_t>(i)];
    const auto& there = strip.stations[static_cast<std::size_t>(other)];
    if ((here.point_px - there.point_px).norm() > kNearWidths * strip.width_px) continue;
    const int early = std::min(i, other);
    const int late = std::max(i, other);
    const auto open = std::find_if(contacts.begin(), contacts.end(), [&](const Contact& contact) {
      return near(contact.early, early, gap) && near(contact.late, late, gap) &&
             early - contact.early.first < longest;
    });
    if (open == contacts.end()) {
      contacts.push_back({{early, early}, {late, late}});
    } else {
      extend(open->early, early);
      extend(open->late, late);
    }
  }
  return contacts;
}

}  // namespace flowdlo::prior
