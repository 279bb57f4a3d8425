// The page as a browser sees it; without one, what can be seen without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "project/command.hpp"
#include "report/curled_trial.hpp"
#include "report/report.hpp"

namespace flowdlo::report {
namespace {

namespace fs = std::filesystem;
using flowdlo::test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

std::string page() {
  const std::vector<eval::Trial> trials{test::curled_trial("one"), test::curled_trial("two")};
  const std::vector<eval::Figure> figures{{"dot", "A dot", {1, 2, 3}}};
  return report_html(trials, "# Results\n\nSaid.\n\n## set: 2 frames\n\n| a |\n|---|\n| 1 |\n",
                     figures);
}

// The name of a Chromium, or nothing.
std::string browser() {
  for (const char* name :
       {"chromium", "chromium-headless-shell", "chromium-browser", "google-chrome"}) {
    if (project::has_program(name)) return name;
  }
  return {};
}

std::string opened(const fs::path& file, const std::string& what, const fs::path& home) {
  return project::run("HOME='" + home.string() + "' timeout 120 " + browser() +
                      " --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader"
                      " --enable-unsafe-swiftshader --hide-scrollbars --window-size=1000,900"
                      " --virtual-time-budget=10000 " +
                      what + " 'file://" + file.string() + "' 2>/dev/null")
      .output;
}

TEST(ReportPage, NeedsNothingFromElsewhere) {
  const std::string html = page();
  for (const char* reference : {" src=\"http", " href=\"http", "@import", "import(", "@SCENES@"}) {
    EXPECT_THAT(html, Not(HasSubstr(reference)));
  }
}

TEST(ReportPage, CarriesTablesFiguresAndTheLicenceOfItsViewer) {
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<td>1</td>"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,AQID"));
  EXPECT_THAT(html, HasSubstr("Permission is hereby granted"));
}

TEST(ReportPage, ViewIsDrawnAndTurnsWithTheMouse) {
  if (browser().empty()) GTEST_SKIP() << "no Chromium is installed (Debian: chromium)";
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "report.html";
  // Drags across the view and keeps where the camera was before.
  std::string html = page();
  const std::string drag = R"(<script>
    const canvas = document.querySelector("#view canvas");
    document.body.dataset.before = document.body.dataset.camera;
    const send = (kind, x, y, target) => target.dispatchEvent(new PointerEvent(kind,
      {pointerId: 1, pointerType: "mouse", button: 0, buttons: 1, clientX: x, clientY: y,
       pageX: x, pageY: y, bubbles: true, isPrimary: true}));
    if (canvas) {
      canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
      send("pointerdown", 300, 300, canvas);
      send("pointermove", 380, 320, canvas.ownerDocument);
      send("pointermove", 460, 330, canvas.ownerDocument);
      send("pointermove", 380, 320, canvas);
      send("pointermove", 460, 330, canvas);
      send("pointerup", 460, 330, canvas.ownerDocument);
    }
  </script></body>)";
  html.replace(html.rfind("</body>"), 7, drag);
  std::ofstream(file) << html;
  const std::string dom = opened(file, "--dump-dom", folder.path());
  ASSERT_THAT(dom, HasSubstr("data-ready=\"yes\"")) << dom.substr(0, 2000);
  const auto value = [&](const std::string& name) {
    const std::string key = "data-" + name + "=\"";
    const auto begin = dom.find(key);
    return begin == std::string::npos
               ? std::string()
               : dom.substr(begin + key.size(),
                            dom.find('"', begin + key.size()) - begin - key.size());
  };
  EXPECT_GT(std::stoi("0" + value("triangles")), 1000);
  EXPECT_GT(std::stod("0" + value("fills")), 0.4);  // of the view, by the first one
  EXPECT_LT(std::stod("0" + value("fills")), 0.95);
  EXPECT_FALSE(value("before").empty());
  EXPECT_NE(value("before"), value("camera"));
}

TEST(ReportPage, CurvesAreSeenInTheirColours) {
  if (browser().empty()) GTEST_SKIP() << "no Chromium is installed (Debian: chromium)";
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "report.html";
  std::ofstream(file) << page();
  const fs::path shot = folder.path() / "shot.png";
  opened(file, "--screenshot='" + shot.string() + "'", folder.path());
  const cv::Mat image = cv::imread(shot.string());
  ASSERT_FALSE(image.empty());
  int green = 0;
  int blue = 0;
  for (auto pixel = image.begin<cv::Vec3b>(); pixel != image.end<cv::Vec3b>(); ++pixel) {
    const cv::Vec3b& p = *pixel;
    green += p[1] > p[0] + 50 && p[1] > p[2] + 50 ? 1 : 0;
    blue += p[0] > p[1] + 50 && p[0] > p[2] + 50 ? 1 : 0;
  }
  EXPECT_GT(green, 300);  // the truth
  EXPECT_GT(blue, 300);   // the estimate
}

}  // namespace
}  // namespace flowdlo::report
