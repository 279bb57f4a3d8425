// A damaged file is an error or loads the very tensors it was written with; it never crashes.
#include <gtest/gtest.h>

#include "random/philox.hpp"
#include "raw_fdw.hpp"
#include "weights/weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

using test::WeightsFolder;

bool same_tensors(const Weights& a, const Weights& b) {
  return std::equal(a.tensors.begin(), a.tensors.end(), b.tensors.begin(), b.tensors.end(),
                    [](const Tensor& left, const Tensor& right) {
                      return left.name == right.name && left.shape == right.shape &&
                             left.values == right.values;
                    });
}

class Damage : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(save(seeded({.visible_points = false}, 1), file_));
    bytes_ = test::bytes_of(file_);
    const auto loaded = load(file_);
    ASSERT_TRUE(loaded);
    intact_ = *loaded;
  }

  void overwrite(std::size_t position, char value) const {
    std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(static_cast<std::streamoff>(position));
    stream.put(value);
  }

  /// Positions outside the tensors' data: tables, offsets, names, metadata.
  [[nodiscard]] std::vector<std::size_t> structure() const {
    std::vector<bool> data(bytes_.size());
    const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes_.data());
    for (const auto* tensor : *fdw::GetWeights(begin)->tensors()) {
      const auto from = static_cast<std::ptrdiff_t>(tensor->data()->data() - begin);
      std::fill_n(data.begin() + from, tensor->data()->size(), true);
    }
    std::vector<std::size_t> positions;
    for (std::size_t i = 0; i < data.size(); ++i) {
      if (!data[i]) positions.push_back(i);
    }
    return positions;
  }

  /// Flips one bit at each position, loads, and mends it.
  void flip_each(const std::vector<std::size_t>& positions, int* errors) const {
    std::uint64_t count = 0;
    for (const std::size_t position : positions) {
      const auto bit = 1U << random::philox(2, count++)[0] % 8;
      overwrite(position, static_cast<char>(static_cast<unsigned char>(bytes_[position]) ^ bit));
      const auto loaded = load(file_);
      if (loaded) {
        ASSERT_TRUE(same_tensors(*loaded, intact_)) << "bit " << bit << " at " << position;
      } else {
        ASSERT_FALSE(loaded.error().message.empty());
        ++*errors;
      }
      overwrite(position, bytes_[position]);
    }
  }

  WeightsFolder folder_;
  std::filesystem::path file_ = folder_ / "model.fdw";
  std::string bytes_;
  Weights intact_;
};

TEST_F(Damage, TruncationAnywhereIsAnError) {
  std::vector<std::size_t> lengths;
  for (std::size_t i = 1; i <= 64; ++i) lengths.push_back(bytes_.size() - i);
  for (std::size_t i = 50; i-- > 1;) lengths.push_back(bytes_.size() * i / 50);
  for (std::size_t i = 257; i-- > 0;) lengths.push_back(i);
  for (const std::size_t length : lengths) {
    std::filesystem::resize_file(file_, length);
    const auto loaded = load(file_);
    ASSERT_FALSE(loaded) << length;
    ASSERT_EQ(loaded.error().code, ErrorCode::kBadWeights) << length;
  }
}

TEST_F(Damage, FlippedBitInTensorDataIsAlwaysAnError) {
  constexpr int kFlips = 60;
  std::vector<std::size_t> positions;
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes_.data());
  const auto& tensors = *fdw::GetWeights(begin)->tensors();
  for (std::uint64_t i = 0; i < kFlips; ++i) {
    const auto words = random::philox(3, i);
    const auto* data = tensors[words[0] % tensors.size()]->data();
    positions.push_back(static_cast<std::size_t>(data->data() - begin) + words[1] % data->size());
  }
  int errors = 0;
  flip_each(positions, &errors);
  EXPECT_EQ(errors, kFlips);
}

TEST_F(Damage, FlippedBitInTheStructureNeverAltersATensor) {
  constexpr std::uint64_t kFlips = 400;
  const auto all = structure();
  std::vector<std::size_t> positions;
  for (std::uint64_t i = 0; i < kFlips; ++i) {
    positions.push_back(all[random::philox(4, i)[0] % all.size()]);
  }
  int errors = 0;
  flip_each(positions, &errors);
  EXPECT_GT(errors, 0);
}

TEST_F(Damage, FlippedBitInTheMetadataNeverAltersATensor) {
  // The builder fills from the back: the root, the list of tensors and the metadata come first.
  std::vector<std::size_t> positions(900);
  for (std::size_t i = 0; i < positions.size(); i += 3) positions[i / 3] = i;
  positions.resize(positions.size() / 3);
  int errors = 0;
  flip_each(positions, &errors);
  EXPECT_GT(errors, 0);
}

TEST_F(Damage, ZeroedStretchIsAnErrorOrHarmless) {
  for (std::size_t begin = 0; begin < 2048; begin += 128) {
    std::string damaged = bytes_;
    std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(begin), 128, '\0');
    test::write_bytes(file_, damaged);
    const auto loaded = load(file_);
    if (loaded) {
      ASSERT_TRUE(same_tensors(*loaded, intact_)) << begin;
    }
  }
}

TEST_F(Damage, ExchangedDataOfTwoLikeTensorsIsAnError) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes_.data());
  const auto& tensors = *fdw::GetWeights(begin)->tensors();
  const auto find = [&tensors](std::string_view name) {
    return *std::find_if(tensors.begin(), tensors.end(), [name](const fdw::Tensor* tensor) {
      return tensor->name()->string_view() == name;
    });
  };
  const auto* first = find("encoder.0.qkv.weight")->data();
  const auto* second = find("encoder.1.qkv.weight")->data();
  std::string damaged = bytes_;
  std::swap_ranges(damaged.begin() + (first->data() - begin),
                   damaged.begin() + (first->data() - begin) + first->size(),
                   damaged.begin() + (second->data() - begin));
  test::write_bytes(file_, damaged);
  const auto loaded = load(file_);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().message.find("SHA-256"), std::string::npos);
}

TEST_F(Damage, FileOfNoiseIsAnError) {
  std::string noise(100000, '\0');
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = static_cast<char>(random::philox(6, i)[0]);
  }
  for (int shift = 0; shift < 64; ++shift) {
    noise[0] = static_cast<char>(4 * shift);
    std::fill_n(noise.begin() + 1, 3, '\0');
    std::copy_n("FDW1", 4, noise.begin() + 4);
    test::write_bytes(file_, noise);
    ASSERT_FALSE(load(file_)) << shift;
  }
}

}  // namespace
}  // namespace flowdlo::weights
