#include "mask_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "durability_choice.hpp"
#include "files/folder_update.hpp"
#include "files/shown_name.hpp"
#include "files/staged_files.hpp"
#include "flowdlo/mask.hpp"
#include "frame_list.hpp"
#include "frame_picture.hpp"
#include "mask_overlay.hpp"
#include "picture_file.hpp"
#include "pixel_argument.hpp"
#include "png_picture.hpp"
#include "progress_bar.hpp"
#include "terminal.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMaskName = "mask.png";
constexpr const char* kOverlayName = "mask_overlay.png";

struct MaskOptions {
  std::vector<fs::path> inputs;
  fs::path out;
  std::vector<int> color;        // red, green, blue, or none
  std::vector<float> lightness;  // two, or none
  std::vector<float> height_m;   // two, or none
  std::vector<std::string> clicks;
  bool table = false;
  bool force = false;
  bool quiet = false;
  ColorBand band;
  HeightBand above;
  SeedGrowth growth;
  MaskCleaning cleaning;
};

constexpr MaskCleaning kRaw{.smooth = false, .fill_holes_px2 = 0, .least_piece_px2 = 0};

Result<Mask> by_seeds(const Frame& frame, const MaskOptions& options) {
  std::vector<Pixel> seeds;
  for (const auto& click : options.clicks) seeds.push_back(*pixel_of(click));
  return mask_from_seeds(frame, seeds, options.growth);
}

/// What all the ways that were asked for have in common, cleaned once.
Result<Mask> made(const Frame& frame, const MaskOptions& options) {
  std::vector<Result<Mask>> ways;
  if (!options.color.empty()) ways.push_back(mask_from_color(frame, options.band));
  if (options.table) ways.push_back(mask_from_plane(frame, options.above));
  if (!options.clicks.empty()) ways.push_back(by_seeds(frame, options));
  Mask shared(frame.mask.size(), 255);
  for (const auto& way : ways) {
    if (!way) return way.error();
    for (std::size_t pixel = 0; pixel < shared.size(); ++pixel) shared[pixel] &= (*way)[pixel];
  }
  return clean_mask(frame.width, frame.height, shared, options.cleaning);
}

/// A file stands for itself, anything else for the frames that it is or holds.
Result<std::vector<support::FrameEntry>> inputs_of(const MaskOptions& options) {
  std::vector<fs::path> folders;
  std::vector<support::FrameEntry> entries;
  for (const auto& input : options.inputs) {
    std::error_code failure;
    if (!fs::is_regular_file(input, failure)) {
      folders.push_back(input);
      continue;
    }
    if (options.out.empty()) {
      return Error{ErrorCode::kBadInput,
                   fmt::format("{}: expected --out DIR for a picture, got none; say where its mask "
                               "goes",
                               files::shown(input))};
    }
    entries.push_back({input, input.stem().string(), [input] { return load_picture(input); }});
  }
  const auto frames = support::list_frames(folders);
  if (!frames) return frames.error();
  entries.insert(entries.end(), frames->begin(), frames->end());
  std::set<std::string> names;
  for (const auto& entry : entries) {
    if (options.out.empty() || names.insert(entry.name).second) continue;
    return Error{
        ErrorCode::kBadInput,
        fmt::format("{}: expected different names, got \"{}\" twice; give them one by one, "
                    "each with an --out of its own",
                    files::shown(entry.folder), files::shown(entry.name))};
  }
  return entries;
}

Result<void> write(const fs::path& folder, const Frame& frame) {
  const auto mask = support::encode_png(mask_of(frame));
  if (!mask) return mask.error();
  const auto overlay = support::encode_png(draw_mask_overlay(frame));
  if (!overlay) return overlay.error();
  files::StagedFiles staged(support::chosen_durability());
  if (auto done = staged.add(folder / kOverlayName, *overlay); !done) return done;
  if (auto done = staged.add(folder / kMaskName, *mask); !done) return done;
  return staged.commit();
}

Result<void> check_place(const fs::path& folder, const support::FrameEntry& entry,
                         const MaskOptions& options) {
  std::error_code failure;
  const bool beside = !options.out.empty() && !fs::equivalent(folder, entry.folder, failure);
  if (beside) {
    fs::create_directories(folder, failure);
    if (!failure) return {};
    return Error{ErrorCode::kIo, fmt::format("--out {}: cannot be made: {}; choose another folder",
                                             files::shown(folder), failure.message())};
  }
  if (options.force ||
      fs::symlink_status(folder / kMaskName, failure).type() == fs::file_type::not_found) {
    return {};
  }
  return Error{
      ErrorCode::kIo,
      fmt::format("{}: there is a mask already; --force replaces it, another --out DIR leaves it",
                  files::shown(folder / kMaskName))};
}

/// What there is to say about one input, or why it has no mask.
Result<std::string> run_one(const support::FrameEntry& entry, const MaskOptions& options) {
  auto loaded = entry.read ? entry.read() : load_frame_folder_without_mask(entry.folder);
  if (!loaded) return loaded.error();
  auto mask = made(loaded->frame(), options);
  if (!mask) return mask.error();
  const auto pixels = std::count(mask->begin(), mask->end(), 255);
  if (pixels == 0) {
    return Error{ErrorCode::kNoEvidence,
                 "no pixel fits; widen --tolerance, --lightness or --height, or click elsewhere"};
  }
  const double share = 100.0 * static_cast<double>(pixels) / static_cast<double>(mask->size());
  loaded->mask = *std::move(mask);
  const fs::path folder = options.out.empty() ? entry.folder : options.out / entry.name;
  if (auto fine = check_place(folder, entry, options); !fine) return fine.error();
  if (auto done = write(folder, loaded->frame()); !done) return done.error();
  return fmt::format("{}: {:.2f} % of the image, {}", files::shown(entry.name), share,
                     files::shown(folder / kOverlayName));
}

void resolve(MaskOptions& options) {
  if (!options.color.empty()) {
    options.band.red = static_cast<std::uint8_t>(options.color[0]);
    options.band.green = static_cast<std::uint8_t>(options.color[1]);
    options.band.blue = static_cast<std::uint8_t>(options.color[2]);
  }
  if (!options.lightness.empty()) {
    options.band.least_lightness = options.lightness[0];
    options.band.most_lightness = options.lightness[1];
  }
  if (!options.height_m.empty()) {
    options.above.least_m = options.height_m[0];
    options.above.most_m = options.height_m[1];
    options.table = true;
  }
  options.growth.tolerance = options.band.tolerance;
  options.band.cleaning = options.above.cleaning = options.growth.cleaning = kRaw;
}

support::ExitCode run(MaskOptions& options) {
  resolve(options);
  if (options.color.empty() && !options.table && options.clicks.empty()) {
    support::tell_error(
        "flowdlo mask: expected a way to the mask, got none; give --color, --table or "
        "--click\n");
    return support::ExitCode::kUsage;
  }
  const auto entries = inputs_of(options);
  if (!entries) {
    support::tell_error("{}\n", entries.error().message);
    return support::ExitCode::kUsage;
  }
  support::ProgressBar progress("mask", static_cast<int>(entries->size()), options.quiet);
  auto exit_code = support::ExitCode::kDone;
  for (const auto& entry : *entries) {
    const auto outcome = run_one(entry, options);
    progress.clear();
    if (!outcome) {
      exit_code = support::ExitCode::kFailed;
      support::tell_error("{}: no mask ({}): {}\n", files::shown(entry.name),
                          name_of(outcome.error().code), outcome.error().message);
    } else if (!options.quiet) {
      support::tell("{}\n", *outcome);
      std::fflush(stdout);
    }
    progress.advance();
  }
  return exit_code;
}

void add_ways(CLI::App& command, MaskOptions& options) {
  command
      .add_option("--color", options.color,
                  "The rope's colour, sRGB of 0-255 each: whatever has it, bright or dark")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(0, 255))
      ->type_name("R,G,B");
  command
      .add_option(
          "--tolerance", options.band.tolerance,
          "Of --color and --click: how far chromaticities may lie apart (a/L, b/L of OKLab)")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 2.0))
      ->type_name("T");
  command
      .add_option("--lightness", options.lightness,
                  "With --color: lightness of the rope, least and most, 0-1 (L of OKLab) [0.15,1]")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0.0, 1.0))
      ->needs("--color")
      ->type_name("L,L");
  command.add_flag("--table", options.table, "What stands out of the table, by depth");
  command
      .add_option("--height", options.height_m,
                  "Metres above the table, least and most; says --table [0.003,0.08]")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1e-4, 10.0))
      ->type_name("M,M");
  command
      .add_option("--click", options.clicks,
                  "A pixel of the rope: what can be reached from it over its colour; may be given "
                  "again, for each piece and colour")
      ->check(a_pixel())
      ->allow_extra_args(false)
      ->type_name("U,V");
  command
      .add_option("--depth-step", options.growth.depth_step_m,
                  "With --click: metres of depth between neighbours at which a region ends")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 10.0))
      ->type_name("M");
}

}  // namespace

void add_mask_command(CLI::App& app, support::ExitCode& exit_code) {
  auto options = std::make_shared<MaskOptions>();
  auto* command = support::add_command(
      app, "mask",
      "Make mask.png for frames or pictures: what --color, --table and --click have in "
      "common");
  command
      ->add_option("FRAME", options->inputs,
                   "Frame folders without a mask, folders of such, or .png pictures")
      ->required();
  command
      ->add_option("--out", options->out,
                   "mask.png and mask_overlay.png go to DIR/<name>/ [into the frame's own folder]")
      ->type_name("DIR");
  add_ways(*command, *options);
  command
      ->add_option("--fill-holes", options->cleaning.fill_holes_px2,
                   "Fill holes of at most so many pixels of an image 640 px wide")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("PX2");
  command
      ->add_option("--least-piece", options->cleaning.least_piece_px2,
                   "Leave out pieces of fewer pixels of an image 640 px wide")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("PX2");
  command->add_flag("--force", options->force, "Replace a mask.png that is there");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace flowdlo::tools
