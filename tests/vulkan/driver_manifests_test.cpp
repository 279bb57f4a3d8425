#include "vulkan/driver_manifests.hpp"

#include <gmock/gmock.h>

#include <map>

#include "frame/temporary_folder.hpp"

namespace flowdlo::vulkan {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// An environment of variables, with files below a folder.
class DriverManifests : public ::testing::Test {
 protected:
  fs::path lay(const std::string& name, const std::string& text = "{}") {
    const fs::path file = scratch_.path() / name;
    fs::create_directories(file.parent_path());
    test::write_text(file, text);
    return file;
  }
  void set(const char* name, const std::string& value) { variables_[name] = value; }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (scratch_.path() / name).string();
  }
  [[nodiscard]] std::vector<fs::path> found() const {
    // Folders of the system's own are the machine's affair.
    auto manifests = driver_manifests([&](const char* name) -> const char* {
      const auto known = variables_.find(name);
      return known == variables_.end() ? nullptr : known->second.c_str();
    });
    std::erase_if(manifests, [&](const fs::path& file) {
      return !file.string().starts_with(scratch_.path().string());
    });
    return manifests;
  }

 private:
  test::TemporaryFolder scratch_;
  std::map<std::string, std::string> variables_;
};

TEST_F(DriverManifests, AreThoseThatDriverFilesNamesAndNoOthers) {
  const auto b = lay("b.json");
  const auto a = lay("a.json");
  const auto data = lay("data/vulkan/icd.d/c.json");
  set("XDG_DATA_HOME", path("data"));
  EXPECT_THAT(found(), ElementsAre(data));
  set("VK_ICD_FILENAMES", a.string());
  EXPECT_THAT(found(), ElementsAre(a));
  set("VK_DRIVER_FILES", b.string() + "::" + a.string() + ":" + b.string());  // comes first
  EXPECT_THAT(found(), ElementsAre(b, a));
  set("VK_DRIVER_FILES", path("missing.json"));
  EXPECT_THAT(found(), IsEmpty());
  set("VK_DRIVER_FILES", path("data/vulkan/icd.d"));  // a folder: all that it holds
  EXPECT_THAT(found(), ElementsAre(data));
}

TEST_F(DriverManifests, ComeFromTheFoldersOfTheLoaderInItsOrder) {
  const auto data_shared = lay("shared/vulkan/icd.d/z.json");
  const auto data_home = lay("data/vulkan/icd.d/y.json");
  const auto config_shared = lay("etc/vulkan/icd.d/x.json");
  const auto config_home = lay("config/vulkan/icd.d/w2.json");
  const auto config_first = lay("config/vulkan/icd.d/w1.json");
  const auto added = lay("added/v.json");
  lay("config/vulkan/icd.d/readme.txt");
  set("XDG_CONFIG_HOME", path("config"));
  set("XDG_CONFIG_DIRS", path("nowhere") + ":" + path("etc"));
  set("XDG_DATA_HOME", path("data"));
  set("XDG_DATA_DIRS", path("shared"));
  set("VK_ADD_DRIVER_FILES", path("added"));
  EXPECT_THAT(found(),
              ElementsAre(added, config_first, config_home, config_shared, data_home, data_shared));
}

TEST_F(DriverManifests, AreLookedForBelowHomeWhereXdgSaysNothing) {
  const auto config = lay("home/.config/vulkan/icd.d/a.json");
  const auto data = lay("home/.local/share/vulkan/icd.d/b.json");
  set("HOME", path("home"));
  EXPECT_THAT(found(), ElementsAre(config, data));
}

TEST_F(DriverManifests, NameTheirLibraryAsTheDynamicLinkerWantsIt) {
  const auto manifest = [](const std::string& library) {
    return R"({"file_format_version": "1.0.0", "ICD": {"library_path": ")" + library + "\"}}";
  };
  EXPECT_EQ(driver_library(lay("a.json", manifest("libvulkan_lvp.so"))), "libvulkan_lvp.so");
  EXPECT_EQ(driver_library(lay("b.json", manifest("/usr/lib/x.so"))), "/usr/lib/x.so");
  EXPECT_EQ(driver_library(lay("icd.d/c.json", manifest("../lib/x.so"))), path("lib/x.so"));
  EXPECT_EQ(driver_library(lay("d.json", "{")), "");
  EXPECT_EQ(driver_library(lay("e.json", R"({"ICD": {"library_path": 7}})")), "");
  EXPECT_EQ(driver_library(lay("f.json", R"([{"ICD": 1}])")), "");
  EXPECT_EQ(driver_library(path("missing.json")), "");
}

}  // namespace
}  // namespace flowdlo::vulkan
