#include "weights/sha256.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace flowdlo::weights {
namespace {

class Sha256Of : public testing::TestWithParam<Sha256::Path> {
 protected:
  static std::string of(std::string_view text) {
    Sha256 sha(GetParam());
    sha.update({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return sha.finish();
  }
};

TEST_P(Sha256Of, NothingIsTheKnownValue) {
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_P(Sha256Of, OneBlockMessageOfFips180IsTheKnownValue) {
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_P(Sha256Of, TwoBlockMessageOfFips180IsTheKnownValue) {
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST_P(Sha256Of, MillionLettersOfFips180AreTheKnownValue) {
  EXPECT_EQ(of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_P(Sha256Of, AnyDivisionOfAMessageIsTheSame) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 7);
  const auto whole = of(text);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Sha256 sha(GetParam());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    sha.update({bytes, cut});
    sha.update({bytes + cut, text.size() - cut});
    ASSERT_EQ(sha.finish(), whole) << cut;
  }
}

TEST_P(Sha256Of, BothPathsAgreeAtEveryLength) {
  std::vector<std::uint8_t> bytes;
  for (int length = 0; length < 260; ++length) {
    Sha256 portable(Sha256::Path::kPortable);
    Sha256 other(GetParam());
    portable.update(bytes);
    other.update(bytes);
    ASSERT_EQ(portable.finish(), other.finish()) << length;
    bytes.push_back(static_cast<std::uint8_t>(31 * length));
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Sha256Of,
                         testing::Values(Sha256::Path::kFastest, Sha256::Path::kPortable));

}  // namespace
}  // namespace flowdlo::weights
