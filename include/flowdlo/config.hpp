// Config: what Estimator::create needs to know. Checked once, there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace flowdlo {

/// How the path becomes 3D; each model is trained on one kind and its weights file says which.
enum class PriorChoice {
  kOfWeights,  ///< what the weights' metadata says; of the weights that come with FlowDLO: refined
  kThesis,     ///< Eq. (3.1)-(3.7): on the visible surface
  kRefined,    ///< on the rope's centerline, uniform in arclength, from every measured pixel
};

/// Who decides between predictions and priors.
enum class GateChoice {
  kOfWeights,  ///< kCalibrated for a trained model that brings a calibration, used with the refined
               ///< prior, as the one that comes with FlowDLO; otherwise kThesis
  kThesis,     ///< Eq. (3.30)-(3.33): the plausible draw of highest mask agreement, or the prior
  kCalibrated,  ///< a score fitted on synthetic scenes, over draws, prior and alternatives: the
                ///< calibration that the weights bring; with none, creating fails with kBadWeights
};

/// Which small networks help beside the reading of the mask: one that sees strands, since a mask
/// cannot tell those that it merges, and one that then moves the nodes to where mask and depth
/// along them say that the rope's axis is.
enum class FieldChoice {
  kBeside,   ///< where its weights are: Config::field_weights, or the `field.safetensors` that
             ///< belongs to Config::weights: in its folder, or within the library; not with the
             ///< thesis' gate, which knows no doubt
  kOff,      ///< neither: the mask alone is read
  kStrands,  ///< as kBeside, but nodes stay where the prior has them
};

/// Where the strand field's network runs.
enum class FieldDevice {
  kFaster,  ///< on the real GPU that Config::device stands for, or on the CPU back end, whichever
            ///< was faster in a trial when the estimator was made; on the CPU where a trial shows
            ///< other values, and beside CPU drivers (lavapipe), which take three times as long
  kCpu,     ///< on the CPU back end, whatever the model runs on
  kSame,    ///< on the device that the model runs on, untried
};

/// How much of the model runs a frame.
enum class Quality {
  kFull,  ///< Config::euler_steps and Config::draws
  kFast,  ///< the K and D that, measured, lose nothing: the weights' metadata hold them; and none
          ///< where the calibrated gate has a strand field, with which it never took a draw
  kAuto,  ///< kFast; kFull where Config::euler_steps or draws is not its default, and where
          ///< Config::gate is kThesis, which chooses among draws
};

/// Most ropes of one frame that are told apart.
inline constexpr int kMostRopes = 32;

struct Config {
  /// A .fdw file. Empty: the one that FLOWDLO_WEIGHTS in the environment names; else the one within
  /// the library, where it was built with it; else `share/flowdlo/flowdlo.fdw` beside the library's
  /// installation or the program.
  std::filesystem::path weights;

  /// "auto": the best real GPU whose self-test passes, otherwise the CPU back end, never a CPU
  /// Vulkan driver; and the CPU as long as a GPU that was lost is not back. "cpu": the native back
  /// end. "vulkan": any Vulkan device, a GPU first. Anything else: part of a device's name, or its
  /// UUID, as `flowdlo devices` prints them.
  std::string device = "auto";

  Quality quality = Quality::kAuto;  ///< kFast takes the place of the next two
  int euler_steps = 10;              ///< K in Eq. (3.26); 1..64
  int draws = 4;                     ///< Gaussian sources a frame, Sec. 4.1.3; 1..64
  std::uint64_t seed = 0;            ///< of the sources x_0; same seed and device: the same bits
  PriorChoice prior = PriorChoice::kOfWeights;
  GateChoice gate = GateChoice::kOfWeights;
  FieldChoice field = FieldChoice::kBeside;
  FieldDevice field_device = FieldDevice::kFaster;
  std::filesystem::path field_weights{};  ///< .safetensors; empty: beside `weights`, if there
  /// How many ropes Estimator::estimate_ropes looks for where no Frame::instances tell; 0: as many
  /// as the mask shows, 1..kMostRopes: so many. Estimator::estimate answers one, whatever this is.
  int ropes = 1;
  double rope_length_m = 0;  ///< of the whole rope, where known; 0: unknown. Helps at crossings,
                             ///< and says how much of it is hidden (docs/hints.md).
  int threads = 0;           ///< of the CPU back end; 0: one for each core

  /// Milliseconds that an estimate may take; 0: as long as it does. Of the model, the strand field
  /// and further readings of a doubtful frame, what would end too late is left out, going by what
  /// earlier frames took; Estimate::left_out says what. Where the strand field is left out the mask
  /// is read, whatever time is left: it takes 2 to 30 ms. With a limit an estimate depends on how
  /// busy the machine is.
  double budget_ms = 0;

  /// Largest frame for which memory is set aside. A larger one still works: its first call
  /// allocates again.
  int max_width = 1280;
  int max_height = 720;

  /// A frame that takes longer on a Vulkan device is kDeviceLost. 0: 10 s for up to 40 draws x
  /// steps and in proportion beyond, six times that on a CPU driver.
  int device_timeout_ms = 0;
  bool validation = false;  ///< Vulkan's validation layers, where installed; slow

  /// Before the first Vulkan driver is loaded, each is asked for its devices in a process of its
  /// own; one that crashes or hangs there is not loaded. What is found is kept in the cache folder.
  /// false: drivers are loaded unseen, as they are where the program for it is not installed.
  bool probe = true;
};

}  // namespace flowdlo
