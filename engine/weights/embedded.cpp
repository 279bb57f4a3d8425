#include "weights/embedded.hpp"

#ifdef FLOWDLO_EMBEDS_WEIGHTS
#include "weights/embedded_files.hpp"
#endif

namespace flowdlo::weights {

Embedded embedded() {
#ifdef FLOWDLO_EMBEDS_WEIGHTS
  return {{flowdlo_embedded_model, flowdlo_embedded_model_end},
          {flowdlo_embedded_field, flowdlo_embedded_field_end}};
#else
  return {};
#endif
}

}  // namespace flowdlo::weights
