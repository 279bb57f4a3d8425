#include <gtest/gtest.h>

#include <cmath>

#include "reference/program.hpp"
#include "support/program_cases.hpp"

namespace flowdlo {
namespace {

using testing::noise;

struct Shape {
  int rows;
  int in;
  int out;
  bool gelu;
  bool residual;
};

std::vector<float> run(const Shape& shape, int threads, bool in_place = false) {
  const auto count = [](int a, int b) { return static_cast<std::size_t>(a) * b; };
  auto program = reference::create_program(threads);
  const auto x = program->input("x", shape.rows, shape.in);
  const auto residual = program->input("residual", shape.rows, shape.out);
  const auto y = program->output("y", shape.rows, shape.out);
  const auto layer = program->layer(
      "w", shape.out, shape.in, noise(count(shape.out, shape.in), 1, 0.1F), noise(shape.out, 2));
  if (in_place) program->record(ops::Copy{.from = residual, .to = y});
  ops::Linear op{.x = x, .layer = layer, .y = y};
  if (shape.gelu) op.activation = ops::Activation::kGelu;
  if (shape.residual) op.residual = in_place ? y : residual;
  program->record(op);
  EXPECT_TRUE(program->build());
  program->write(x, noise(count(shape.rows, shape.in), 3));
  program->write(residual, noise(count(shape.rows, shape.out), 4));
  EXPECT_TRUE(program->run());
  std::vector<float> result(count(shape.rows, shape.out));
  program->read(y, result);
  return result;
}

/// The same sum in double precision, one entry at a time.
class PlainLinear {
 public:
  explicit PlainLinear(const Shape& shape)
      : shape_(shape),
        weight_(noise(static_cast<std::size_t>(shape.out) * shape.in, 1, 0.1F)),
        bias_(noise(shape.out, 2)),
        x_(noise(static_cast<std::size_t>(shape.rows) * shape.in, 3)),
        residual_(noise(static_cast<std::size_t>(shape.rows) * shape.out, 4)) {}

  double operator()(int row, int column) const {
    const auto in = static_cast<std::size_t>(shape_.in);
    const auto r = static_cast<std::size_t>(row);
    const auto c = static_cast<std::size_t>(column);
    double sum = static_cast<double>(bias_[c]);
    for (std::size_t i = 0; i < in; ++i) {
      sum += static_cast<double>(weight_[c * in + i]) * static_cast<double>(x_[r * in + i]);
    }
    if (shape_.gelu) sum = 0.5 * sum * (1 + std::erf(sum / std::sqrt(2.0)));
    if (shape_.residual) {
      sum += static_cast<double>(residual_[r * static_cast<std::size_t>(shape_.out) + c]);
    }
    return sum;
  }

 private:
  Shape shape_;
  std::vector<float> weight_;
  std::vector<float> bias_;
  std::vector<float> x_;
  std::vector<float> residual_;
};

class Linear : public ::testing::TestWithParam<Shape> {};

TEST_P(Linear, EqualsThePlainSumInDoublePrecision) {
  const Shape shape = GetParam();
  const auto y = run(shape, 2);
  const PlainLinear expected(shape);
  for (const int row : {0, 1, 31, 63, shape.rows - 1}) {
    for (const int column : {0, 1, 127, 128, 255, shape.out - 1}) {
      EXPECT_NEAR(y[static_cast<std::size_t>(row) * shape.out + column], expected(row, column),
                  2e-5)
          << "row " << row << ", column " << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Linear,
    ::testing::Values(Shape{64, 256, 256, false, false}, Shape{256, 256, 768, false, false},
                      Shape{256, 256, 1024, true, false}, Shape{192, 1024, 256, false, true},
                      Shape{128, 256, 256, true, true}, Shape{256, 256, 512, false, false}));

TEST(Linear, ResidualMayBeTheResultItself) {
  for (const bool gelu : {false, true}) {
    const Shape shape{128, 256, 256, gelu, true};
    EXPECT_EQ(run(shape, 2, true), run(shape, 2, false));
  }
}

TEST(Linear, BitsDoNotDependOnTheNumberOfThreads) {
  const Shape shape{256, 1024, 256, false, true};
  EXPECT_EQ(run(shape, 1), run(shape, 2));
}

TEST(Linear, BitsOfADrawDoNotDependOnTheNumberOfDraws) {
  const auto one = run({64, 256, 1024, true, false}, 2);
  const auto four = run({256, 256, 1024, true, false}, 2);
  EXPECT_TRUE(std::equal(one.begin(), one.end(), four.begin()));
}

TEST(Linear, GeluStaysWithinOneHundredThousandthOfTheErfForm) {
  constexpr int kRows = 64;
  auto program = reference::create_program(1);
  const auto x = program->input("x", kRows, 256);
  const auto y = program->output("y", kRows, 256);
  std::vector<float> identity(256 * 256, 0.0F);
  for (std::size_t i = 0; i < 256; ++i) identity[i * 257] = 1.0F;
  const auto layer = program->layer("identity", 256, 256, identity, std::vector<float>(256, 0.0F));
  program->record(
      ops::Linear{.x = x, .layer = layer, .y = y, .activation = ops::Activation::kGelu});
  ASSERT_TRUE(program->build());
  std::vector<float> values(kRows * 256);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = -12.0F + 24.0F * static_cast<float>(i) / static_cast<float>(values.size());
  }
  program->write(x, values);
  ASSERT_TRUE(program->run());
  std::vector<float> result(values.size());
  program->read(y, result);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double v = static_cast<double>(values[i]);
    ASSERT_NEAR(result[i], 0.5 * v * (1 + std::erf(v / std::sqrt(2.0))), 1e-5) << "at " << v;
  }
}

}  // namespace
}  // namespace flowdlo
