// Program: operations on tensors, recorded once, run once a frame.
//
// The velocity model, its sampler and the strand field are written once, against this interface.
// Two rooms implement it: `reference` (Eigen, the CPU back end) and `vulkan` (one submission a
// run). Every tensor is f32, row-major, [rows, columns]. An operation sees the results of those
// recorded before it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../shaders/frame_params.h"  // struct FrameParams, shared with GLSL
#include "flowdlo/result.hpp"

namespace flowdlo::ops {

inline constexpr int kWidth = 256;        ///< d, spec section 6
inline constexpr int kHeads = 8;          ///< spec section 6
inline constexpr int kHeadWidth = 32;     ///< kWidth / kHeads
inline constexpr int kRowsPerDraw = 64;   ///< N
inline constexpr int kVisibleRows = 256;  ///< K_obs
inline constexpr float kLayerNormEpsilon = 1e-5F;

struct Tensor {
  std::uint32_t id = 0;
  int rows = 0;
  int columns = 0;
};

/// A dense layer kept by the program: y = x W^T + b.
struct LinearLayer {
  std::uint32_t id = 0;
  int in = 0;
  int out = 0;
};

/// A convolution kept by the program; see Convolution.
struct ConvolutionLayer {
  std::uint32_t id = 0;
  int in = 0;
  int out = 0;
  int taps = 9;
};

enum class Activation { kNone, kGelu };  ///< GELU is the erf form, to within 1e-5 absolute
enum class Parameterization { kVelocity, kDirect, kPreconditioned };

/// Rows of a table added to an operation's result: row r takes table[r % period + offset].
struct Addend {
  Tensor table;
  int period = 1;
  int offset = 0;
};

/// y = act(x W^T + b) + residual. x [R, in], y [R, out], residual [R, out] or none; residual may be
/// y itself. in is 256 or 1024, out a multiple of 256; R a multiple of 64.
struct Linear {
  Tensor x;
  LinearLayer layer;
  Tensor y;
  Activation activation = Activation::kNone;
  std::optional<Tensor> residual = std::nullopt;
};

/// y = act(x W^T + b) + first + second. x [R, 4] or [R, 8]; the layer's `in` is at most x.columns,
/// and x's further columns do not contribute. y [R, 256]. R a multiple of 64.
struct Narrow {
  Tensor x;
  LinearLayer layer;
  Tensor y;
  Activation activation = Activation::kNone;
  std::optional<Addend> first = std::nullopt;
  std::optional<Addend> second = std::nullopt;
};

/// y[r, :] = (x[r, :] - mean) / sqrt(var + 1e-5) * gain + shift, two-pass. x, y [R, 256];
/// gain, shift [1, 256]. y must not be x.
struct LayerNorm {
  Tensor x;
  Tensor gain;
  Tensor shift;
  Tensor y;
};

/// out = softmax(q k^T / sqrt(32)) v for each of 8 heads of 32 channels.
/// Row r's query is query[r, query_column + 32 h ...]; keys and values are columns key_column and
/// value_column of `key_value`. `per_draw`: row r sees the 64 rows of its own draw (r / 64);
/// otherwise every row sees all rows of key_value (256). Where `key_valid` is given
/// [key_value.rows, 4], keys whose column 3 is below 0.5 are left out; no key left: the output is
/// 0.
struct Attention {
  Tensor query;
  int query_column = 0;
  Tensor key_value;
  int key_column = 0;
  int value_column = 0;
  bool per_draw = true;
  std::optional<Tensor> key_valid = std::nullopt;
  Tensor out;  ///< [R, 256], heads contiguous
};

/// Farthest-point sampling of the first params.point_count rows of cloud [capacity, 4] (column 3
/// unused) to visible [256, 4]; column 3 is the validity, 1 or 0. Starts at the point farthest from
/// params.centroid; ties go to the lower index; distances are ((dx*dx + dy*dy) + dz*dz) in f32
/// without contraction, so that every implementation picks the same points, bit for bit. At most
/// 256 points: all, in order, then repeated from the first with validity 0; none: zeros.
struct FarthestPoints {
  Tensor cloud;
  Tensor params;
  Tensor visible;
};

/// norm [1, 4] = (mean, scale) of the valid rows of points [256, 4] (column 3 above 0.5): mean, and
/// root mean square distance to it, Eq. (3.8), (3.9) of this frame. A scale below 1e-6, or no valid
/// row: scale 1.
struct FrameNormalization {
  Tensor points;
  Tensor norm;
};

/// out[:, 0:3] = (points[:, 0:3] - mean) / scale, Eq. (3.10); column 3 is copied. [R, 4].
struct Normalize {
  Tensor points;
  Tensor norm;
  Tensor out;
};

/// out[:, 0:3] = scale * state[:, 0:3] + mean, Eq. (3.10); column 3 is copied. [R, 4].
struct Denormalize {
  Tensor state;
  Tensor norm;
  Tensor out;
};

/// Local features phi_M(u_j) at the projections of state [R, 4], Sec. 3.4 and spec section 6.
/// out [R, 8]: columns 0..5 the mask features; 6..7 the depth residual of Eq. (3.16) and its
/// validity when `depth` is given, otherwise zero.
/// field [capacity, 4]: see evidence::MaskField, row v * field_width + u; read bilinearly, in all
/// four channels, at the clamped position ((u + 0.5) * field_width / width - 0.5, same for v).
/// Column 2 is the length of the bilinear displacement. Displacements become pixels of a
/// 640-px-wide image by 640 / field_width, then / 100, clamped to [-3, 3].
/// depth [capacity, 1]: metres, row v * width + u, read at the nearest pixel (floor(u + 0.5)).
struct MaskFeatures {
  Tensor state;
  Tensor norm;
  Tensor params;
  Tensor field;
  std::optional<Tensor> depth = std::nullopt;
  Tensor out;
};

/// Head and Euler update, Eq. (3.26)-(3.29). o = hidden W^T + b, layer 256 to 3 or 4.
/// velocity: x += dt * o. direct: x += dt * (o - x) / max(1 - t, 1e-6). preconditioned, with
/// p = prior[:, 0:3] (normalised), s = prior_sd, den = t^2 s^2 + (1 - t)^2:
/// x += dt * (p + (t s^2 - (1 - t)) / den * (x - t p) + s / sqrt(den) * o).
/// state [R, 4]: columns 0..2 are x, updated in place; column 3 becomes o[3] (log-sigma), or 0.
struct FlowStep {
  Tensor hidden;
  LinearLayer head;
  Tensor prior;
  Tensor state;
  Parameterization parameterization = Parameterization::kVelocity;
  float prior_sd = 0;
  float t = 0;
  float dt = 0;
};

// Images, of which only some blocks are kept. A block is a square of `side` x `side` places, side
// 16, 8 or 4, and one row of a tensor is one place: row (block * side + y) * side + x, its columns
// the place's channels. Which blocks lie beside each other says a map [capacity, 12], the same for
// every side: column 3 (dy + 1) + (dx + 1) is the block that lies there, as a float, or -1:
// nothing, where zeros are read. Column 4 is the block itself, or -1 where it is not in use: such
// blocks come last, and what their rows hold is nobody's business. Columns 9 to 11 are 0.

/// y = act(sum over taps of W_tap x at the tap's place + b). x [capacity * side^2, layer.in],
/// y [capacity * side^2, layer.out]; both a multiple of 16; (side + 2)^2 * layer.in at most 16384.
/// Nine taps: a square of 3 x 3 around the place, row by row; one: the place itself.
struct Convolution {
  Tensor x;
  Tensor map;
  ConvolutionLayer layer;
  Tensor y;
  int side = 16;
  bool relu = true;  ///< act; otherwise none
};

/// The largest of each 2 x 2 places. x [capacity * side^2, c], y [capacity * (side / 2)^2, c], c a
/// multiple of 16.
struct MaxPool {
  Tensor x;
  Tensor map;
  Tensor y;
  int side = 16;  ///< of x: 16 or 8
};

/// y += x, each place of x over 2 x 2 places of y. x [capacity * (side / 2)^2, c],
/// y [capacity * side^2, c], c a multiple of 16.
struct AddUpsampled {
  Tensor x;
  Tensor map;
  Tensor y;
  int side = 16;  ///< of y: 16 or 8
};

/// Copies `from` to `to`; same shape.
struct Copy {
  Tensor from;
  Tensor to;
};

class Program {
 public:
  virtual ~Program() = default;

  // Declarations, before the first operation that uses them.

  /// Written by the host before a run.
  virtual Tensor input(std::string_view name, int rows, int columns) = 0;
  /// Read by the host after a run; operations may also read it.
  virtual Tensor output(std::string_view name, int rows, int columns) = 0;
  /// Seen by operations alone.
  virtual Tensor scratch(std::string_view name, int rows, int columns) = 0;
  /// Fixed for the program's life; values are copied.
  virtual Tensor constant(std::string_view name, int rows, int columns,
                          std::span<const float> values) = 0;
  /// weight [out, in], bias [out]; copied, packed as the implementation likes.
  virtual LinearLayer layer(std::string_view name, int out, int in, std::span<const float> weight,
                            std::span<const float> bias) = 0;

  /// weight [out, taps, in], bias [out]; likewise. taps is 9 or 1.
  virtual ConvolutionLayer convolution(std::string_view name, int out, int taps, int in,
                                       std::span<const float> weight,
                                       std::span<const float> bias) = 0;

  /// Whether the host had better sample the visible points and write them as an input, since here
  /// FarthestPoints takes longer than there. Both give the same bits.
  [[nodiscard]] virtual bool host_samples_points() const { return false; }

  // Operations, in order of execution.

  virtual void record(const Linear& op) = 0;
  virtual void record(const Narrow& op) = 0;
  virtual void record(const LayerNorm& op) = 0;
  virtual void record(const Attention& op) = 0;
  virtual void record(const FarthestPoints& op) = 0;
  virtual void record(const FrameNormalization& op) = 0;
  virtual void record(const Normalize& op) = 0;
  virtual void record(const Denormalize& op) = 0;
  virtual void record(const MaskFeatures& op) = 0;
  virtual void record(const FlowStep& op) = 0;
  virtual void record(const Convolution& op) = 0;
  virtual void record(const MaxPool& op) = 0;
  virtual void record(const AddUpsampled& op) = 0;
  virtual void record(const Copy& op) = 0;
  /// Operations from here on are timed under `name`; a name may come back.
  virtual void stage(std::string_view name) = 0;

  // Life.

  /// Ends recording: allocates, compiles, warms up. Once.
  [[nodiscard]] virtual Result<void> build() = 0;
  /// Fills the first values.size() floats of an input.
  virtual void write(Tensor input, std::span<const float> values) = 0;
  /// All operations once, in one submission. Fails with kDeviceLost.
  [[nodiscard]] virtual Result<void> run() = 0;
  /// Copies the first values.size() floats of an output of the last run.
  virtual void read(Tensor output, std::span<float> values) const = 0;
  /// Milliseconds of the last run by stage, in order of first appearance.
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> stage_times_ms() const = 0;
};

}  // namespace flowdlo::ops
