// Triangles: what a host does with its device beside FlowDLO: it renders off-screen, and looks at
// the picture.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/host.hpp"

namespace flowdlo::testing {

class Triangles {
 public:
  /// Null where something failed.
  [[nodiscard]] static std::unique_ptr<Triangles> make(Host& host);

  /// Renders `count` triangles over one another, in one submission, and reads the picture back.
  /// Whether its middle is green and its corners are black.
  [[nodiscard]] bool render(std::uint32_t count);

  Triangles(const Triangles&) = delete;
  Triangles& operator=(const Triangles&) = delete;
  ~Triangles();

 private:
  explicit Triangles(Host& host);
  [[nodiscard]] bool make_image();
  [[nodiscard]] bool make_pass();
  [[nodiscard]] bool make_pipeline();
  [[nodiscard]] VkShaderModule module_of(const std::uint32_t* words, std::size_t bytes) const;

  Host& host_;
  VkDevice device_;
  HostBuffer picture_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace flowdlo::testing
