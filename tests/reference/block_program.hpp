// A program of every operation with a kernel of its own: one transformer block on given rows.
#pragma once

#include <memory>
#include <vector>

#include "ops/program.hpp"
#include "support/program_cases.hpp"

namespace flowdlo::testing {

/// Output of the block for `draws` draws of the same noise.
struct BlockProgram {
  BlockProgram(std::unique_ptr<ops::Program> made, int draws)
      : program(std::move(made)), rows(draws * ops::kRowsPerDraw) {
    ops::Program& p = *program;
    const auto layer = [&](int columns, int in, std::uint64_t seed) {
      return p.layer("", columns, in, noise(static_cast<std::size_t>(columns) * in, seed, 0.05F),
                     noise(columns, seed + 1, 0.1F));
    };
    const auto x = p.input("x", rows, 4);
    const auto table = p.constant("table", 64, 256, noise(64 * 256, 2));
    const auto gain = p.constant("gain", 1, 256, noise(256, 3));
    const auto shift = p.constant("shift", 1, 256, noise(256, 4));
    const auto valid_rows = p.constant("valid", rows, 4, std::vector<float>(4 * rows, 1.0F));
    const auto tokens = p.scratch("tokens", rows, 256);
    const auto normed = p.scratch("normed", rows, 256);
    const auto qkv = p.scratch("qkv", rows, 768);
    const auto hidden = p.scratch("hidden", rows, 1024);
    out = p.output("out", rows, 256);
    p.record(ops::Narrow{.x = x,
                         .layer = layer(256, 4, 5),
                         .y = tokens,
                         .activation = ops::Activation::kGelu,
                         .first = ops::Addend{table, 64, 0},
                         .second = ops::Addend{table, 1, 3}});
    p.record(ops::LayerNorm{.x = tokens, .gain = gain, .shift = shift, .y = normed});
    p.record(ops::Linear{.x = normed, .layer = layer(768, 256, 7), .y = qkv, .residual = {}});
    for (const bool per_draw : {true, false}) {
      if (!per_draw && rows > 256) continue;  // no more keys than that
      ops::Attention attention{.query = qkv,
                               .query_column = 0,
                               .key_value = qkv,
                               .key_column = 256,
                               .value_column = 512,
                               .per_draw = per_draw,
                               .key_valid = {},
                               .out = out};
      if (!per_draw) attention.key_valid = valid_rows;
      p.record(attention);
      p.record(ops::Linear{.x = out, .layer = layer(256, 256, 9), .y = tokens, .residual = tokens});
    }
    p.record(ops::Linear{.x = tokens,
                         .layer = layer(1024, 256, 11),
                         .y = hidden,
                         .activation = ops::Activation::kGelu,
                         .residual = {}});
    p.record(ops::Linear{.x = hidden, .layer = layer(256, 1024, 13), .y = out, .residual = tokens});
    if (!p.build()) return;
    std::vector<float> input;
    for (int draw = 0; draw < draws; ++draw) {
      const auto one = noise(64 * 4, 1);
      input.insert(input.end(), one.begin(), one.end());
    }
    p.write(x, input);
  }

  [[nodiscard]] std::vector<float> run() const {
    std::vector<float> values(static_cast<std::size_t>(rows) * 256);
    if (program->run()) program->read(out, values);
    return values;
  }

  std::unique_ptr<ops::Program> program;
  int rows;
  ops::Tensor out;
};

}  // namespace flowdlo::testing
