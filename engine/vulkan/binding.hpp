// Binding: a piece of a resource, and how a kernel looks at it.
#pragma once

#include <cstdint>

#include "vulkan/vulkan_api.hpp"

namespace flowdlo::vulkan {

/// Bytes of one resource of a program.
struct Range {
  std::uint32_t resource = 0;
  VkDeviceSize offset = 0;
  VkDeviceSize size = 0;
};

enum class BindingKind : std::uint8_t {
  kTexels,   ///< samplerBuffer of RGBA32F: the fast read on every driver
  kWords,    ///< usamplerBuffer of RGBA32UI
  kScalars,  ///< samplerBuffer of R32F
  kStorage,  ///< std430 buffer
};

struct Binding {
  BindingKind kind = BindingKind::kStorage;
  bool reads = false;
  bool writes = false;
  Range range;
};

// What a kernel's argument struct is made of: one field a binding, in the shader's order.

struct Texels {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kTexels, true, false, range};
  }
};

struct Words {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kWords, true, false, range};
  }
};

struct Scalars {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kScalars, true, false, range};
  }
};

struct Reads {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kStorage, true, false, range};
  }
};

struct Writes {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kStorage, false, true, range};
  }
};

struct Updates {
  Range range;
  operator Binding() const {  // NOLINT
    return {BindingKind::kStorage, true, true, range};
  }
};

}  // namespace flowdlo::vulkan
