// flowdlo_make_scene OUT_DIR [--kind K] [--seed S]: one synthetic frame folder with truth.
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

#include "flowdlo/frame_folder.hpp"
#include "scene/scene.hpp"

namespace {

int usage() {
  std::cerr << "usage: flowdlo_make_scene OUT_DIR [--kind K] [--seed S]\nkinds:";
  for (int i = 0; i < flowdlo::lab::kKinds; ++i) {
    std::cerr << ' ' << flowdlo::lab::name_of(static_cast<flowdlo::lab::Kind>(i));
  }
  std::cerr << '\n';
  return 2;
}

}  // namespace

int main(int count, char** values) {
  std::filesystem::path out;
  auto kind = flowdlo::lab::Kind::kOneCrossing;
  std::uint64_t seed = 0;
  for (int i = 1; i < count; ++i) {
    const std::string_view argument = values[i];
    if (argument == "--kind" && i + 1 < count) {
      const auto named = flowdlo::lab::kind_of(values[++i]);
      if (!named) return usage();
      kind = *named;
    } else if (argument == "--seed" && i + 1 < count) {
      const std::string_view text = values[++i];
      const auto read = std::from_chars(text.data(), text.data() + text.size(), seed);
      if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return usage();
    } else if (argument.starts_with("-") || !out.empty()) {
      return usage();
    } else {
      out = argument;
    }
  }
  if (out.empty()) return usage();
  const flowdlo::lab::Scene scene = flowdlo::lab::make_scene(kind, seed);
  const auto saved = flowdlo::save_frame_folder(out, scene.frame(), 0.001, &scene.truth);
  if (!saved) {
    std::cerr << saved.error().message << '\n';
    return 1;
  }
  std::cout << out.string() << ": " << flowdlo::lab::name_of(kind) << ", seed " << seed << '\n';
  return 0;
}
