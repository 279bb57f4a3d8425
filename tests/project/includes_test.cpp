// The rooms of engine/ include downwards only; engine/README.md's table says what is down.
#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "project/include_rules.hpp"
#include "project/tree.hpp"
#include "support/source_dir.hpp"

namespace flowdlo::project {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const Rooms kThreeRooms = {{"flow", 1}, {"reference", 2}, {"vulkan", 2}, {"ops", 3}};

bool is_source(const std::string& path) {
  const auto extension = std::filesystem::path(path).extension();
  return extension == ".hpp" || extension == ".cpp" || extension == ".h";
}

/// Sources of engine/, from engine/.
std::vector<std::string> engine_sources() {
  std::vector<std::string> sources;
  for (const auto& path : project_files()) {
    if (path.starts_with("engine/") && is_source(path)) {
      sources.push_back(path.substr(7));
    }
  }
  return sources;
}

TEST(IncludeRules, LowerRoomIsAllowed) {
  EXPECT_EQ(complaint(kThreeRooms, "flow/sampler.cpp", {"ops/program.hpp"}), "");
}

TEST(IncludeRules, OwnRoomIsAllowed) {
  EXPECT_EQ(complaint(kThreeRooms, "flow/sampler.cpp", {"flow/sampler.hpp"}), "");
}

TEST(IncludeRules, HigherRoomIsRefused) {
  EXPECT_THAT(complaint(kThreeRooms, "ops/program.cpp", {"flow/sampler.hpp"}),
              HasSubstr("flow (layer 1) is not below ops (layer 3)"));
}

TEST(IncludeRules, NeighbourOnTheSameLayerIsRefused) {
  EXPECT_THAT(complaint(kThreeRooms, "vulkan/device.cpp", {"reference/kernels.hpp"}),
              HasSubstr("is not below vulkan"));
}

TEST(IncludeRules, RoomOutsideTheTableIsRefused) {
  EXPECT_THAT(complaint(kThreeRooms, "attic/box.cpp", {"ops/program.hpp"}),
              HasSubstr("got \"attic\""));
}

TEST(IncludeRules, VulkanHeadersBelongToTheVulkanRoom) {
  EXPECT_EQ(complaint(kThreeRooms, "vulkan/device.hpp", {"volk.h", true}), "");
  EXPECT_THAT(complaint(kThreeRooms, "flow/sampler.cpp", {"volk.h", true}), HasSubstr("Vulkan"));
  EXPECT_THAT(complaint(kThreeRooms, "flow/sampler.cpp", {"vulkan/vulkan.h", true}),
              HasSubstr("Vulkan"));
}

TEST(IncludeRules, ThePublicHeaderThatSeesVulkanBelongsToItsRoomToo) {
  EXPECT_EQ(complaint(kThreeRooms, "vulkan/device.cpp", {"flowdlo/vulkan.hpp"}), "");
  EXPECT_THAT(complaint(kThreeRooms, "flow/sampler.cpp", {"flowdlo/vulkan.hpp"}),
              HasSubstr("only engine/vulkan"));
  EXPECT_EQ(complaint(kThreeRooms, "flow/sampler.cpp", {"flowdlo/frame.hpp"}), "");
}

TEST(IncludeRules, OnlyTheShadersHeadersMayBeReachedByDots) {
  EXPECT_EQ(complaint(kThreeRooms, "ops/program.hpp", {"../../shaders/frame_params.h"}), "");
  EXPECT_THAT(complaint(kThreeRooms, "ops/program.hpp", {"../flow/sampler.hpp"}),
              HasSubstr("write it from engine/"));
}

TEST(IncludeRules, BothFormsOfIncludeAreRead) {
  const auto includes = includes_of("#include <a/b.h>\n  # include \"c.hpp\"  // why\nint d;\n");

  ASSERT_EQ(includes.size(), 2);
  EXPECT_EQ(includes[0].target, "a/b.h");
  EXPECT_TRUE(includes[0].angled);
  EXPECT_EQ(includes[1].target, "c.hpp");
  EXPECT_FALSE(includes[1].angled);
}

TEST(EngineReadme, NamesEveryRoomFolderAndNoOther) {
  const auto rooms = parse_rooms(read("engine/README.md"));
  std::set<std::string> in_table;
  for (const auto& [room, layer] : rooms) {
    in_table.insert(room);
  }
  std::set<std::string> on_disk;
  for (const auto& source : engine_sources()) {
    on_disk.insert(source.substr(0, source.find('/')));
  }
  EXPECT_EQ(in_table, on_disk);
}

TEST(Engine, IncludesRunDownwardsOnly) {
  const auto rooms = parse_rooms(read("engine/README.md"));
  std::vector<std::string> complaints;
  for (const auto& source : engine_sources()) {
    for (const auto& include : includes_of(read("engine/" + source))) {
      if (auto words = complaint(rooms, source, include); !words.empty()) {
        complaints.push_back(words);
      }
    }
  }
  EXPECT_THAT(complaints, IsEmpty());
}

TEST(Engine, IncludesOfItsOwnFilesAreWrittenFromEngine) {
  namespace fs = std::filesystem;
  const fs::path engine = test::source_dir() / "engine";
  std::vector<std::string> complaints;
  for (const auto& source : engine_sources()) {
    for (const auto& include : includes_of(read("engine/" + source))) {
      const bool beside = fs::exists((engine / source).parent_path() / include.target);
      if (beside && !include.target.starts_with("../") && !fs::exists(engine / include.target)) {
        complaints.push_back(source + ": write \"" + include.target + "\" from engine/");
      }
    }
  }
  EXPECT_THAT(complaints, IsEmpty());
}

}  // namespace
}  // namespace flowdlo::project
