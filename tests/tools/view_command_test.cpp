// flowdlo view, run as a user would run it, its page fetched and looked at in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "mat/mat_png.hpp"
#include "support/source_dir.hpp"
#include "tools/program.hpp"
#include "tools/view/http_client.hpp"
#include "tools/view/viewer.hpp"

namespace flowdlo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::body_of;
using test::fetched;
using test::read_text;
using test::run_flowdlo;
using test::status_of;
using test::TemporaryFolder;
using test::Viewer;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::string shipped_frame() { return test::source_dir() / "examples/frames/overhand_loop"; }

/// The name of a Chromium, or nothing.
std::string browser() {
  for (const char* name :
       {"chromium", "chromium-headless-shell", "chromium-browser", "google-chrome"}) {
    if (std::system(("command -v " + std::string(name) + " > /dev/null 2>&1").c_str()) == 0) {
      return name;
    }
  }
  return {};
}

/// What the browser prints, or the picture that it took.
std::string looked_at(const std::string& url, const std::string& what, const fs::path& scratch) {
  const auto out = scratch / "browser.txt";
  const std::string line = "HOME='" + scratch.string() + "' timeout 120 " + browser() +
                           " --headless --no-sandbox --disable-gpu --hide-scrollbars"
                           " --window-size=1400,700 --virtual-time-budget=20000 " +
                           what + " '" + url + "' > '" + out.string() + "' 2>/dev/null";
  static_cast<void>(std::system(line.c_str()));
  return read_text(out);
}

cv::Mat decoded(const std::string& png) {
  const std::vector<std::uint8_t> bytes(png.begin(), png.end());
  const auto image = mat::decode_png(bytes, "picture");
  return image ? *image : cv::Mat();
}

TEST(ViewCommand, ServesTheFrameAndWhatWasMadeOfIt) {
  const TemporaryFolder scratch;
  Viewer viewer(scratch.path(), {shipped_frame()});
  EXPECT_THAT(viewer.url(), MatchesRegex("http://[0-9.]+:[0-9]+/[0-9a-f]{32}/"));
  EXPECT_THAT(viewer.get(""), HasSubstr("<title>FlowDLO: view</title>"));
  EXPECT_EQ(body_of(viewer.get("frames.json")), "[\"overhand_loop\"]");
  const json scene = json::parse(body_of(viewer.get("frames/0/scene.json")));
  ASSERT_EQ(scene["ropes"].size(), 1U);
  EXPECT_EQ(scene["ropes"][0]["nodes"].size(), 64U);
  EXPECT_GT(scene["ropes"][0]["confidence"], 0.5);
  EXPECT_EQ(scene["prior"].size(), 64U);
  EXPECT_EQ(scene["draws"].size(), 2U);
  EXPECT_GT(scene["path"].size(), 50U);
  EXPECT_GT(scene["measured"].size(), 500U);
  EXPECT_TRUE(scene["field"]);
  for (const char* picture : {"image", "mask", "field"}) {
    const auto image = decoded(body_of(viewer.get("frames/0/" + std::string(picture) + ".png")));
    EXPECT_EQ(image.cols, scene["width"]) << picture;
    EXPECT_EQ(image.rows, scene["height"]) << picture;
  }
  EXPECT_EQ(status_of(fetched(viewer.port(), "/")), "404");  // without the secret
  EXPECT_EQ(viewer.end(SIGTERM), 0);
}

TEST(ViewCommand, ShowsSeveralRopesAndFramesWithoutAnEstimate) {
  const TemporaryFolder scratch;
  const auto bad = scratch.path() / "bad";
  fs::create_directories(bad);
  Viewer viewer(scratch.path(), {shipped_frame(), bad.string(), "--ropes", "auto"});
  const json good = json::parse(body_of(viewer.get("frames/0/scene.json")));
  EXPECT_EQ(good["ropes"].size(), 1U);
  EXPECT_FALSE(good.contains("draws"));
  const json none = json::parse(body_of(viewer.get("frames/1/scene.json")));
  EXPECT_THAT(none["error"].get<std::string>(), HasSubstr("camera.json"));
  EXPECT_EQ(status_of(viewer.get("frames/1/image.png")), "404");
  EXPECT_EQ(viewer.end(SIGINT), 0);
}

TEST(ViewCommand, EndsWithTwoOnWrongUsage) {
  const TemporaryFolder scratch;
  const Viewer first(scratch.path(), {shipped_frame()});
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"view"},
           {"view", shipped_frame(), "--port", "65536"},
           {"view", shipped_frame(), "--weights", "none.fdw"},
           {"view", shipped_frame(), "--device", "cpu", "--weights", FLOWDLO_WEIGHTS, "--port",
            std::to_string(first.port())}}) {
    const auto outcome = run_flowdlo(scratch.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
    EXPECT_NE(outcome.err, "");
  }
}

TEST(ViewCommand, IsSeenInABrowser) {
  if (browser().empty()) GTEST_SKIP() << "no Chromium is installed (Debian: chromium)";
  const TemporaryFolder scratch;
  fs::create_directories(scratch.path() / "bad");
  const Viewer viewer(scratch.path(), {shipped_frame(), (scratch.path() / "bad").string()});
  const std::string bad = looked_at(viewer.url() + "#1", "--dump-dom", scratch.path());
  EXPECT_THAT(bad, HasSubstr("data-frame=\"bad\""));
  EXPECT_THAT(bad, HasSubstr("<dt>none</dt><dd class=\"bad\">"));
  const std::string dom = looked_at(viewer.url(), "--dump-dom", scratch.path());
  ASSERT_THAT(dom, HasSubstr("data-ready=\"yes\"")) << dom.substr(0, 3000);
  EXPECT_THAT(dom, HasSubstr("data-frame=\"overhand_loop\""));
  EXPECT_THAT(dom, HasSubstr("data-below=\"image\""));
  EXPECT_THAT(dom, HasSubstr("<dt>confidence</dt>"));
  const auto shot = scratch.path() / "shot.png";
  looked_at(viewer.url(), "--screenshot='" + shot.string() + "'", scratch.path());
  const cv::Mat image = decoded(read_text(shot));
  ASSERT_FALSE(image.empty());
  // The curve's colour in both halves: over the picture, and in space, clear of the box's border.
  std::array<int, 2> teal{};
  int at_border = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const auto* p = image.ptr<std::uint8_t>(v) + u * image.channels();
      const bool is_teal = p[1] > 150 && p[0] > 120 && p[2] < 90;
      if (!is_teal || u > 1110) continue;  // the facts and their legend
      ++teal[u < 560 ? 0 : 1];
      at_border += u > 1090 || (u > 560 && (u < 580 || v > image.rows - 50)) ? 1 : 0;
    }
  }
  EXPECT_GT(teal[0], 300);
  EXPECT_GT(teal[1], 300);
  EXPECT_EQ(at_border, 0);  // the first view shows all of the rope
}

}  // namespace
}  // namespace flowdlo
