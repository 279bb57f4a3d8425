#include "weights/location.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "weights/embedded_files.hpp"
#include "weights/field_weights.hpp"
#include "weights/kept_file.hpp"
#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::uint8_t kSomeModel[] = {1, 2, 3};
const std::uint8_t kSomeField[] = {4, 5};

/// What the target flowdlo::weights holds, in this library or not.
Embedded shipped() {
  return {{flowdlo_embedded_model, flowdlo_embedded_model_end},
          {flowdlo_embedded_field, flowdlo_embedded_field_end}};
}

std::vector<std::uint8_t> content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// An installation in `root`: a program below it, and weights below its folder `prefix`.
class Installed {
 public:
  Installed(const fs::path& root, const fs::path& program, const fs::path& prefix = {})
      : program_(root / program) {
    fs::create_directories(program_.parent_path());
    const fs::path share = root / prefix / "share" / "flowdlo";
    fs::create_directories(share);
    std::ofstream(share / "flowdlo.fdw") << "a model";
    std::ofstream(share / "field.safetensors") << "a field";
    model_ = share / "flowdlo.fdw";
  }

  [[nodiscard]] const fs::path& model() const { return model_; }
  [[nodiscard]] Surroundings surroundings() const { return {nullptr, {}, {program_}}; }

 private:
  fs::path program_;
  fs::path model_;
};

class LocationTest : public testing::Test {
 protected:
  /// A folder of its own for each installation.
  [[nodiscard]] fs::path root() { return folder_.path() / std::to_string(++roots_); }

 private:
  test::WeightsFolder folder_;
  int roots_ = 0;
};

TEST_F(LocationTest, OfThisBuildIsWhatWasBuiltForIt) {
  const auto found = default_location();
  ASSERT_TRUE(found) << found.error().message;
  if (!embedded().model.empty()) {
    EXPECT_EQ(found->model.bytes.data(), flowdlo_embedded_model);
    EXPECT_EQ(found->field.bytes.data(), flowdlo_embedded_field);
  } else {  // build/<preset>/share/flowdlo
    EXPECT_EQ(fs::canonical(found->model.file), fs::canonical(FLOWDLO_DEFAULT_WEIGHTS));
    EXPECT_EQ(found->field.file.filename(), "field.safetensors");
  }
}

TEST_F(LocationTest, IsBesideTheProgramOrUpToThreeFoldersAbove) {
  for (const char* program : {"robot", "bin/robot", "lib/triplet/librobot.so", "a/b/c/robot"}) {
    const Installed installed(root(), program);
    const auto found = default_location(installed.surroundings());
    ASSERT_TRUE(found) << program << ": " << found.error().message;
    EXPECT_EQ(found->model.file, installed.model());
    EXPECT_EQ(found->field.file, installed.model().parent_path() / "field.safetensors");
  }
  EXPECT_FALSE(default_location(Installed(root(), "a/b/c/d/robot").surroundings()));
}

TEST_F(LocationTest, IsLookedForBesideEveryProgramInTurn) {
  const Installed without(root(), "lib/librobot.so", "elsewhere");
  const Installed with(root(), "bin/robot");
  Surroundings both = without.surroundings();
  both.programs.push_back(with.surroundings().programs.front());
  const auto found = default_location(both);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->model.file, with.model());
}

TEST_F(LocationTest, IsNotWhereAnybodyMayWrite) {
  for (const int above : {0, 1, 2, 3}) {  // the file, share/flowdlo, share, and what holds it
    const Installed installed(root(), "bin/robot");
    fs::path open = installed.model();
    for (int i = 0; i < above; ++i) open = open.parent_path();
    fs::permissions(open, fs::perms::others_write, fs::perm_options::add);
    const auto found = default_location(installed.surroundings());
    ASSERT_FALSE(found) << open;
    EXPECT_EQ(found.error().code, ErrorCode::kBadWeights);
    EXPECT_THAT(found.error().message, HasSubstr("anybody may write there"));
  }
}

TEST_F(LocationTest, WithinTheLibraryComesBeforeWhatLiesBesideIt) {
  const Installed installed(root(), "bin/robot");
  Surroundings surroundings = installed.surroundings();
  surroundings.embedded = {kSomeModel, kSomeField};
  const auto found = default_location(surroundings);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->model.bytes.data(), kSomeModel);
  EXPECT_EQ(found->field.bytes.data(), kSomeField);
}

TEST_F(LocationTest, OfTheEnvironmentComesFirst) {
  const Installed installed(root(), "bin/robot");
  const Installed other(root(), "bin/robot");
  Surroundings surroundings = installed.surroundings();
  surroundings.embedded = {kSomeModel, kSomeField};
  surroundings.named = other.model().c_str();
  const auto found = default_location(surroundings);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->model.file, other.model());
  EXPECT_EQ(found->field.file, other.model().parent_path() / "field.safetensors");
  EXPECT_TRUE(found->model.bytes.empty());
}

TEST_F(LocationTest, OfTheEnvironmentHasToBeThereUnlessItIsEmpty) {
  const Installed installed(root(), "bin/robot");
  Surroundings surroundings = installed.surroundings();
  surroundings.named = "no/such/model.fdw";
  const auto found = default_location(surroundings);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::kBadWeights);
  EXPECT_THAT(found.error().message, HasSubstr("FLOWDLO_WEIGHTS"));
  EXPECT_THAT(found.error().message, HasSubstr("no/such/model.fdw"));
  surroundings.named = "";
  EXPECT_TRUE(default_location(surroundings));
}

TEST_F(LocationTest, NowhereIsSaidWithAllPlacesAndEachOnce) {
  const fs::path here = root();
  const fs::path program = here / "bin" / "robot";
  const auto found = default_location({nullptr, {}, {program, program}});
  ASSERT_FALSE(found);
  const auto once = (here / "share" / "flowdlo" / "flowdlo.fdw").string();
  const auto first = found.error().message.find(once);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(found.error().message.find(once, first + 1), std::string::npos);
}

TEST(EmbeddedFiles, AreTheShippedOnesByteForByte) {
  const auto same = [](std::span<const std::uint8_t> bytes, const char* file) {
    const auto expected = content(file);
    return !expected.empty() &&
           std::equal(bytes.begin(), bytes.end(), expected.begin(), expected.end());
  };
  EXPECT_TRUE(same(shipped().model, FLOWDLO_DEFAULT_WEIGHTS));
  EXPECT_TRUE(same(shipped().field, FLOWDLO_FIELD_WEIGHTS));
}

TEST(EmbeddedFiles, AreReadWhereTheyLie) {
  const auto loaded = keep({"a name", shipped().model});
  const auto from_file = load(FLOWDLO_DEFAULT_WEIGHTS);
  ASSERT_TRUE(loaded && from_file);
  const auto anew = loaded->decoded();
  ASSERT_EQ(anew.tensors.size(), from_file->tensors.size());
  for (std::size_t i = 0; i < anew.tensors.size(); ++i) {
    EXPECT_EQ(anew.tensors[i].values, from_file->tensors[i].values);
  }
  const auto field = load_field(Place{"a name", shipped().field});
  const auto field_from_file = load_field(fs::path(FLOWDLO_FIELD_WEIGHTS));
  ASSERT_TRUE(field && field_from_file);
  EXPECT_EQ(field->at("head.weight").values, field_from_file->at("head.weight").values);
}

TEST(EmbeddedFiles, ThatAreDamagedAreNamed) {
  const auto loaded = keep({"a name", kSomeModel});
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::kBadWeights);
  EXPECT_THAT(loaded.error().message, HasSubstr("a name"));
}

}  // namespace
}  // namespace flowdlo::weights
