// WideScenes: which rendered scenes of the split `wide` a report goes over.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>

namespace flowdlo::lab {

struct WideScenes {
  std::string part = "validation";  ///< or "training"
  std::uint64_t first = 0;          ///< index of the first scene
  std::uint64_t scenes = 100;
};

/// --part, --first and --scenes; what `scenes` holds is what they are where they are not given.
inline void add_options(CLI::App& app, WideScenes& scenes) {
  app.add_option("--part", scenes.part, "Of the wide split: training or validation")
      ->check(CLI::IsMember({"training", "validation"}))
      ->capture_default_str();
  app.add_option("--first", scenes.first, "Index of the first scene")->capture_default_str();
  app.add_option("--scenes", scenes.scenes, "How many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
}

/// --threads.
inline void add_threads_option(CLI::App& app, int& threads) {
  app.add_option("--threads", threads, "Scenes at a time; 0: one a core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

}  // namespace flowdlo::lab
