// flowdlo_make_scene OUT_DIR [--kind K] [--seed S] [--ropes N [--labels]]: one synthetic frame
// folder, of one rope with its truth, or of several, with their labels where these are asked for.
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

#include "flowdlo/frame_folder.hpp"
#include "scene/ropes.hpp"
#include "scene/scene.hpp"

namespace {

using namespace flowdlo;

constexpr double kDepthScale_m = 0.001;
constexpr int kMostDrawn = 9;

struct Options {
  std::filesystem::path out;
  std::string kind;
  std::uint64_t seed = 0;
  std::uint64_t ropes = 1;
  bool labels = false;
};

int usage() {
  std::cerr << "usage: flowdlo_make_scene OUT_DIR [--kind K] [--seed S] [--ropes N [--labels]]\n"
               "kinds of one rope:";
  for (int i = 0; i < lab::kKinds; ++i) std::cerr << ' ' << name_of(static_cast<lab::Kind>(i));
  std::cerr << "\nof 2 to " << kMostDrawn << " ropes:";
  for (int i = 0; i < lab::kRopesKinds; ++i) {
    std::cerr << ' ' << name_of(static_cast<lab::RopesKind>(i));
  }
  std::cerr << '\n';
  return 2;
}

bool read_number(std::string_view text, std::uint64_t& number) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

bool read_options(int count, char** values, Options& options) {
  for (int i = 1; i < count; ++i) {
    const std::string_view argument = values[i];
    const bool more = i + 1 < count;
    if (argument == "--kind" && more) {
      options.kind = values[++i];
    } else if (argument == "--seed" && more) {
      if (!read_number(values[++i], options.seed)) return false;
    } else if (argument == "--ropes" && more) {
      if (!read_number(values[++i], options.ropes)) return false;
      if (options.ropes < 1 || options.ropes > kMostDrawn) return false;
    } else if (argument == "--labels") {
      options.labels = true;
    } else if (argument.starts_with("-") || !options.out.empty()) {
      return false;
    } else {
      options.out = argument;
    }
  }
  return !options.out.empty() && (options.ropes > 1 || !options.labels);
}

int told(const Options& options, const Result<void>& saved, std::string_view kind) {
  if (!saved) {
    std::cerr << saved.error().message << '\n';
    return 1;
  }
  std::cout << options.out.string() << ": " << kind << ", seed " << options.seed << '\n';
  return 0;
}

int make_one(const Options& options) {
  const auto kind = lab::kind_of(options.kind.empty() ? "one-crossing" : options.kind);
  if (!kind) return usage();
  const lab::Scene scene = lab::make_scene(*kind, options.seed);
  const auto saved = save_frame_folder(options.out, scene.frame(), kDepthScale_m, &scene.truth);
  return told(options, saved, name_of(*kind));
}

int make_several(const Options& options) {
  const auto kind = lab::ropes_kind_of(options.kind.empty() ? "crossing" : options.kind);
  if (!kind) return usage();
  const auto scene = lab::make_ropes(*kind, static_cast<int>(options.ropes), options.seed);
  const auto saved = save_frame_folder(options.out, scene.frame(options.labels), kDepthScale_m);
  return told(options, saved, name_of(*kind));
}

}  // namespace

int main(int count, char** values) {
  Options options;
  if (!read_options(count, values, options)) return usage();
  return options.ropes == 1 ? make_one(options) : make_several(options);
}
