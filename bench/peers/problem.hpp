// Problem: one frame's conditions as every peer takes them, and what a peer is.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "evidence/mask_field.hpp"
#include "flowdlo/result.hpp"
#include "ops/program.hpp"
#include "weights/weights.hpp"

namespace flowdlo::peers {

/// Everything an Euler sampling starts from. Rows are [.., 4]; D draws of 64 rows.
struct Problem {
  weights::Weights weights;
  int draws = 4;
  int steps = 10;
  int threads = 1;
  std::vector<float> source;   ///< [D * 64, 4] x_0
  std::vector<float> prior;    ///< [D * 64, 4] camera frame, column 3 the support
  std::vector<float> visible;  ///< [256, 4] camera frame, column 3 the validity
  std::array<float, 4> norm{};
  ops::FrameParams params{};
  std::vector<float> field;  ///< evidence::MaskField's texels
  std::vector<float> depth;  ///< empty for six local channels

  [[nodiscard]] int rows() const { return draws * ops::kRowsPerDraw; }
  /// (x - mean) / scale, Eq. (3.10); column 3 is copied.
  [[nodiscard]] std::vector<float> normalised(const std::vector<float>& rows) const;
  /// dx/dt of one coordinate, Eq. (3.27), (3.29) and spec section 6.
  [[nodiscard]] float velocity(float t, float output, float x, float prior) const;
  /// Nodes [rows, 4] after K steps of a network that always says 0: what is left to compare is the
  /// network's own share.
  [[nodiscard]] std::vector<float> without_network() const;
  /// phi_M of normalised states [rows, 4]: [rows, 8].
  void features(const std::vector<float>& state, std::vector<float>& out) const;
};

/// The frame's conditions by the engine's own stages. Fails as reading and gathering do.
[[nodiscard]] Result<Problem> make_problem(const std::filesystem::path& weights,
                                           const std::filesystem::path& frame, int draws, int steps,
                                           int threads);

/// One way to do the sampling: from the conditions to the state after K steps.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Normalised nodes [D * 64, 4] after K Euler steps; column 3 is not compared.
  virtual void sample(std::vector<float>& state) = 0;
};

}  // namespace flowdlo::peers
