#include <fmt/format.h>

#include <algorithm>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kBlock = 4;  // keys that a subgroup hands round in one round of its loop
// A lane's, where a subgroup's then lie within one draw. Every key handed round serves all of them;
// twice as many of either, and the loop leaves the instruction cache of a CPU driver's core. Where
// all lanes read a key from one address, nothing is handed round: one query leaves a GPU's
// registers for twice as many subgroups.
constexpr int kMostQueries = 4;

bool sound(Plan& plan, const ops::Attention& op) {
  const int keys = op.per_draw ? ops::kRowsPerDraw : op.key_value.rows;
  const bool aligned =
      op.query_column % 4 == 0 && op.key_column % 4 == 0 && op.value_column % 4 == 0;
  const bool fits =
      aligned && op.query.rows % ops::kRowsPerDraw == 0 && keys % kBlock == 0 &&
      op.query_column + ops::kWidth <= op.query.columns &&
      std::max(op.key_column, op.value_column) + ops::kWidth <= op.key_value.columns &&
      op.out.columns == ops::kWidth && op.out.rows == op.query.rows &&
      (!op.per_draw || op.key_value.rows == op.query.rows);
  if (!fits) {
    plan.fault(
        fmt::format("Attention: expected out as query [64 n, 256], keys in blocks of {}, "
                    "columns in fours, got query [{}, {}], key_value [{}, {}], out [{}, {}]",
                    kBlock, op.query.rows, op.query.columns, op.key_value.rows,
                    op.key_value.columns, op.out.rows, op.out.columns));
  }
  if (!op.per_draw && !plan.fits(plan.whole(op.key_value), 16)) {
    plan.fault(fmt::format("Attention: expected at most {} texels of shared keys, got [{}, {}]",
                           plan.most_texels(), op.key_value.rows, op.key_value.columns));
    return false;
  }
  return fits;
}

/// Which of the keys that a row of `rows` sees count: the operation's own, or ones for all.
Range valid_of(Plan& plan, const ops::Attention& op, Window rows) {
  if (!op.key_valid) return plan.ones(op.per_draw ? ops::kRowsPerDraw : op.key_value.rows);
  return op.per_draw ? plan.rows(*op.key_valid, rows) : plan.whole(*op.key_valid);
}

}  // namespace

void record_attention(Plan& plan, const ops::Attention& op) {
  if (!sound(plan, op)) return;
  const int lanes = plan.lanes();
  // Lanes of two draws do not read the same keys.
  const bool hands_round = plan.hands_round() || lanes > ops::kRowsPerDraw;
  const int queries = hands_round ? std::clamp(ops::kRowsPerDraw / lanes, 1, kMostQueries) : 1;
  const int columns =
      op.per_draw ? std::max(plan.pitch(op.query), plan.pitch(op.key_value)) : plan.pitch(op.query);
  for (const Window rows : Plan::windows(op.query.rows, plan.most_texels() / (columns / 4))) {
    const Range query = plan.rows(op.query, rows);
    const Range keys = op.per_draw ? plan.rows(op.key_value, rows) : plan.whole(op.key_value);
    const Range valid = valid_of(plan, op, rows);
    const AttentionCall call{.query = {query},
                             .key_value = {keys},
                             .valid = {valid},
                             .result = {plan.rows(op.out, rows)},
                             .key_rows = {keys},
                             .valid_rows = {valid}};
    plan.dispatch(call,
                  {.lanes = lanes,
                   .queries = queries,
                   .block = std::min(kBlock, lanes),
                   .few_keys = op.key_valid && op.per_draw ? ops::kRowsPerDraw : 0,
                   .hands_round = hands_round ? 1 : 0},
                  {.rows = rows.count,
                   .query_stride = plan.pitch(op.query) / 4,
                   .query_column = op.query_column / 4,
                   .key_value_stride = plan.pitch(op.key_value) / 4,
                   .key_column = op.key_column / 4,
                   .value_column = op.value_column / 4,
                   .keys_a_draw = op.per_draw ? ops::kRowsPerDraw : 0,
                   .valid_a_draw = op.per_draw && op.key_valid ? ops::kRowsPerDraw : 0},
                  {ops::kHeads, static_cast<std::uint32_t>((rows.count + lanes * queries - 1) /
                                                           (lanes * queries))});
  }
}

}  // namespace flowdlo::vulkan
