#include "support/naive_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace flowdlo::testing {
namespace {

using Row = std::vector<double>;
using Rows = std::vector<Row>;

const std::vector<float>& values(const weights::Weights& weights, const std::string& name) {
  return weights.at(name).values;
}

Row dense(const weights::Weights& weights, const std::string& name, const Row& x) {
  const auto& weight = values(weights, name + ".weight");
  const auto& bias = values(weights, name + ".bias");
  Row y(bias.size());
  for (std::size_t out = 0; out < y.size(); ++out) {
    double sum = static_cast<double>(bias[out]);
    for (std::size_t in = 0; in < x.size(); ++in) {
      sum += static_cast<double>(weight[out * x.size() + in]) * x[in];
    }
    y[out] = sum;
  }
  return y;
}

Row gelu(Row x) {
  for (double& v : x) v = 0.5 * v * (1 + std::erf(v / std::sqrt(2.0)));
  return x;
}

Row silu(Row x) {
  for (double& v : x) v = v / (1 + std::exp(-v));
  return x;
}

Row sum(Row a, const Row& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

Row layer_norm(const weights::Weights& weights, const std::string& name, const Row& x) {
  const auto& gain = values(weights, name + ".weight");
  const auto& shift = values(weights, name + ".bias");
  double mean = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  double variance = 0;
  for (const double v : x) variance += (v - mean) * (v - mean) / static_cast<double>(x.size());
  Row y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    y[i] = (x[i] - mean) / std::sqrt(variance + 1e-5) * static_cast<double>(gain[i]) +
           static_cast<double>(shift[i]);
  }
  return y;
}

/// Heads of 32 channels; q, k, v start at the given columns.
Rows attention(const Rows& queries, std::size_t q, const Rows& memory, std::size_t k, std::size_t v,
               const std::vector<bool>& valid) {
  Rows out(queries.size(), Row(256, 0.0));
  if (std::none_of(valid.begin(), valid.end(), [](bool b) { return b; })) return out;
  for (std::size_t row = 0; row < queries.size(); ++row) {
    for (std::size_t head = 0; head < 8; ++head) {
      std::vector<double> weight(memory.size(), 0.0);
      double total = 0;
      for (std::size_t key = 0; key < memory.size(); ++key) {
        if (!valid[key]) continue;
        double dot = 0;
        for (std::size_t c = 0; c < 32; ++c) {
          dot += queries[row][q + head * 32 + c] * memory[key][k + head * 32 + c];
        }
        weight[key] = std::exp(dot / std::sqrt(32.0));
        total += weight[key];
      }
      for (std::size_t key = 0; key < memory.size(); ++key) {
        for (std::size_t c = 0; c < 32; ++c) {
          out[row][head * 32 + c] += weight[key] / total * memory[key][v + head * 32 + c];
        }
      }
    }
  }
  return out;
}

struct Normalization {
  std::array<double, 3> mean{};
  double scale = 1;
};

Normalization normalization(const weights::Metadata& metadata, const NaiveInput& input) {
  Normalization norm;
  if (metadata.variant.normalization == weights::NormalizationKind::kGlobal) {
    for (std::size_t i = 0; i < 3; ++i) norm.mean[i] = static_cast<double>(metadata.mean[i]);
    norm.scale = static_cast<double>(metadata.scale);
    return norm;
  }
  double count = 0;
  for (const auto& p : input.visible) {
    if (p[3] < 0.5) continue;
    for (std::size_t i = 0; i < 3; ++i) norm.mean[i] += p[i];
    count += 1;
  }
  for (double& m : norm.mean) m /= count;
  double square = 0;
  for (const auto& p : input.visible) {
    if (p[3] < 0.5) continue;
    for (std::size_t i = 0; i < 3; ++i) square += (p[i] - norm.mean[i]) * (p[i] - norm.mean[i]);
  }
  norm.scale = std::sqrt(square / count);
  return norm;
}

Row normalized(const Normalization& norm, const std::array<double, 4>& p) {
  return {(p[0] - norm.mean[0]) / norm.scale, (p[1] - norm.mean[1]) / norm.scale,
          (p[2] - norm.mean[2]) / norm.scale};
}

/// Spec section 6, "Local features at u_j".
Row local_features(const NaiveInput& input, const Normalization& norm,
                   const std::array<double, 3>& state, int channels) {
  Row phi(static_cast<std::size_t>(channels), 0.0);
  const Frame& frame = input.frame;
  const double x = norm.scale * state[0] + norm.mean[0];
  const double y = norm.scale * state[1] + norm.mean[1];
  const double z = norm.scale * state[2] + norm.mean[2];
  if (z <= 0.02) return phi;
  const double u =
      static_cast<double>(frame.intrinsics.fx) * x / z + static_cast<double>(frame.intrinsics.cx);
  const double v =
      static_cast<double>(frame.intrinsics.fy) * y / z + static_cast<double>(frame.intrinsics.cy);
  const int w = input.field.width;
  const int h = input.field.height;
  const double fu = std::clamp((u + 0.5) * w / frame.width - 0.5, 0.0, w - 1.0);
  const double fv = std::clamp((v + 0.5) * h / frame.height - 0.5, 0.0, h - 1.0);
  const int left = static_cast<int>(fu);
  const int top = static_cast<int>(fv);
  double read[4];
  for (int c = 0; c < 4; ++c) {
    const auto at = [&](int row, int column) {
      row = std::min(row, h - 1);
      column = std::min(column, w - 1);
      return static_cast<double>(
          input.field.texels[(static_cast<std::size_t>(row) * w + column) * 4 + c]);
    };
    read[c] =
        (1 - (fv - top)) * ((1 - (fu - left)) * at(top, left) + (fu - left) * at(top, left + 1)) +
        (fv - top) * ((1 - (fu - left)) * at(top + 1, left) + (fu - left) * at(top + 1, left + 1));
  }
  const double unit = 640.0 / w / 100.0;
  phi[0] = read[0];
  phi[1] = read[1];
  phi[2] = std::min(std::hypot(read[2], read[3]) * unit, 3.0);
  phi[3] = std::clamp(read[2] * unit, -3.0, 3.0);
  phi[4] = std::clamp(read[3] * unit, -3.0, 3.0);
  const bool inside = u > -0.5 && u < frame.width - 0.5 && v > -0.5 && v < frame.height - 0.5;
  phi[5] = inside ? 1 : 0;
  if (channels == 8 && inside) {
    const auto column = static_cast<std::size_t>(std::floor(u + 0.5));
    const auto row = static_cast<std::size_t>(std::floor(v + 0.5));
    const double seen =
        static_cast<double>(frame.depth_m[row * static_cast<std::size_t>(frame.width) + column]);
    if (seen >= 0.05 && seen <= 0.5) {
      phi[6] = std::clamp(seen - z, -0.2, 0.2) / 0.2;
      phi[7] = 1;
    }
  }
  return phi;
}

Row time_token(const weights::Weights& weights, double t) {
  Row embedding(256);
  for (std::size_t i = 0; i < 128; ++i) {
    const double angle = 1000 * t * std::pow(10000.0, -static_cast<double>(i) / 128);
    embedding[i] = std::sin(angle);
    embedding[128 + i] = std::cos(angle);
  }
  return dense(weights, "time.2", silu(dense(weights, "time.0", embedding)));
}

void feed_forward(const weights::Weights& weights, const std::string& norm, const std::string& up,
                  const std::string& down, Rows& tokens) {
  for (Row& z : tokens) {
    z = sum(z, dense(weights, down, gelu(dense(weights, up, layer_norm(weights, norm, z)))));
  }
}

Rows network(const weights::Weights& weights, const NaiveInput& input, const Normalization& norm,
             const std::vector<std::array<double, 3>>& state, double t) {
  const auto& variant = weights.metadata.variant;
  const Row time = time_token(weights, t);
  Rows tokens;
  for (std::size_t j = 0; j < 64; ++j) {  // Eq. (3.13)
    Row z = sum(dense(weights, "state", {state[j][0], state[j][1], state[j][2]}), time);
    const auto& node = values(weights, "node");
    for (std::size_t c = 0; c < 256; ++c) z[c] += static_cast<double>(node[j * 256 + c]);
    z = sum(z, dense(weights, "prior", normalized(norm, input.draw_prior[j])));
    z = sum(z, dense(weights, "support", {input.draw_prior[j][3]}));
    tokens.push_back(z);
  }
  if (variant.visible_points) {  // Eq. (3.14)
    Rows memory;
    std::vector<bool> valid;
    for (const auto& point : input.visible) {
      const Row g =
          dense(weights, "points.2", gelu(dense(weights, "points.0", normalized(norm, point))));
      memory.push_back(dense(weights, "cross.kv", layer_norm(weights, "cross.norm_points", g)));
      valid.push_back(point[3] > 0.5);
    }
    Rows queries;
    for (const Row& z : tokens) {
      queries.push_back(dense(weights, "cross.q", layer_norm(weights, "cross.norm_query", z)));
    }
    const Rows read = attention(queries, 0, memory, 0, 256, valid);
    for (std::size_t j = 0; j < 64; ++j)
      tokens[j] = sum(tokens[j], dense(weights, "cross.out", read[j]));
    feed_forward(weights, "cross.norm_ffn", "cross.up", "cross.down", tokens);
  }
  const double gamma = static_cast<double>(values(weights, "gamma").front());
  for (std::size_t j = 0; j < 64; ++j) {  // Eq. (3.15)
    Row local = dense(weights, "local.2",
                      gelu(dense(weights, "local.0",
                                 local_features(input, norm, state[j], variant.local_channels))));
    for (double& value : local) value *= gamma;
    tokens[j] = sum(tokens[j], local);
  }
  for (int layer = 0; layer < 6; ++layer) {
    const std::string name = "encoder." + std::to_string(layer);
    Rows qkv;
    for (const Row& z : tokens) {
      qkv.push_back(dense(weights, name + ".qkv", layer_norm(weights, name + ".norm1", z)));
    }
    const Rows read = attention(qkv, 0, qkv, 256, 512, std::vector<bool>(64, true));
    for (std::size_t j = 0; j < 64; ++j)
      tokens[j] = sum(tokens[j], dense(weights, name + ".out", read[j]));
    feed_forward(weights, name + ".norm2", name + ".up", name + ".down", tokens);
  }
  Rows out;
  for (const Row& z : tokens) out.push_back(dense(weights, "head", layer_norm(weights, "norm", z)));
  return out;
}

}  // namespace

NaiveOutput naive_sample(const weights::Weights& weights, const NaiveInput& input, int steps) {
  const auto& variant = weights.metadata.variant;
  const Normalization norm = normalization(weights.metadata, input);
  NaiveOutput output{input.source, {}, std::vector<double>(64, 0.0)};
  for (int k = 0; k < steps; ++k) {  // Eq. (3.26)
    const double t = static_cast<double>(k) / steps;
    const double dt = 1.0 / steps;
    const Rows o = network(weights, input, norm, output.state, t);
    for (std::size_t j = 0; j < 64; ++j) {
      const Row p = normalized(norm, input.draw_prior[j]);
      for (std::size_t c = 0; c < 3; ++c) {
        double& x = output.state[j][c];
        const double s = static_cast<double>(variant.prior_sd);
        const double den = t * t * s * s + (1 - t) * (1 - t);
        switch (variant.parameterization) {
          case ops::Parameterization::kVelocity:
            x += dt * o[j][c];
            break;
          case ops::Parameterization::kDirect:
            x += dt * (o[j][c] - x) / std::max(1 - t, 1e-6);
            break;
          case ops::Parameterization::kPreconditioned:
            x += dt * (p[c] + (t * s * s - (1 - t)) / den * (x - t * p[c]) +
                       s / std::sqrt(den) * o[j][c]);
            break;
        }
      }
      if (variant.head_channels == 4) output.log_sigma[j] = o[j][3];
    }
  }
  for (const auto& x : output.state) {
    output.nodes.push_back({norm.scale * x[0] + norm.mean[0], norm.scale * x[1] + norm.mean[1],
                            norm.scale * x[2] + norm.mean[2]});
  }
  return output;
}

}  // namespace flowdlo::testing
