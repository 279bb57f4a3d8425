#include "faults/relayed.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "vulkan/driver_manifests.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/kept_drivers.hpp"

namespace flowdlo::testing {
namespace {

/// Lavapipe's library as its manifest names it; empty without one.
std::string lavapipe() {
  for (const std::filesystem::path& manifest : vulkan::driver_manifests(std::getenv)) {
    const std::string library = vulkan::driver_library(manifest);
    if (library.find("libvulkan_lvp") != std::string::npos) return library;
  }
  return {};
}

}  // namespace

const RelayTable* relay() {
  static const RelayTable* const table = []() -> const RelayTable* {
    const std::string target = lavapipe();
    if (target.empty()) return nullptr;
    ::setenv("RELAY_TARGET", target.c_str(), /*overwrite=*/1);
    void* const library = dlopen(FLOWDLO_RELAY_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return nullptr;
    return reinterpret_cast<const RelayTable* (*)()>(dlsym(library, "relay"))();
  }();
  return table;
}

void Relayed::SetUp() {
  if (relay() == nullptr) GTEST_SKIP() << "lavapipe is not installed (mesa-vulkan-drivers)";
  drivers_.emplace(FLOWDLO_RELAY);
  vulkan::forget_findings();
  relay()->reset();
  relay()->pose_as_gpu(false);
  relay()->hide(false);
  relay()->limit({});
}

void Relayed::TearDown() {
  if (relay() == nullptr) return;
  relay()->reset();
  relay()->pose_as_gpu(false);
  relay()->hide(false);
  relay()->limit({});
  vulkan::forget_findings();
  vulkan::forget_drivers();
  EXPECT_EQ(relay()->alive(), 0) << "objects of Vulkan are left";
}

}  // namespace flowdlo::testing
