// The page in a headless Chromium, where one is installed: what its mouse and its keys do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "frame/temporary_folder.hpp"
#include "tools/sample_estimate.hpp"
#include "tools/view/rope_before_wall.hpp"
#include "view/http_server.hpp"
#include "view/pages.hpp"

namespace flowdlo::view {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

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

ShownFrame shown(std::size_t frame) {
  const test::RopeBeforeWall rope;
  if (frame == 1) return shown_failure("two", Error{ErrorCode::kIo, "<b>gone</b>"});
  Seen seen;
  seen.ropes = test::sample_ropes();
  if (frame == 0) seen.ropes.ropes.resize(1);
  return *shown_frame("one", rope.frame(), seen);
}

/// The page as the browser has it once `script` has run: when the first frame is there, with what
/// it does after that.
std::string page_after(const std::string& script) {
  Pages pages("key", {"one", "two", "three"}, shown);
  const auto handler = [&](const HttpRequest& request) {
    auto response = pages.response(request);
    if (request.target != "/key/view.js") return response;
    response.body += R"(
      const fire = (kind, on, x, y, more) => {
        const box = on.getBoundingClientRect();
        const at = { clientX: box.left + x, clientY: box.top + y, bubbles: true, pointerId: 1 };
        const Kind = kind === "wheel" ? WheelEvent : kind.startsWith("pointer") ? PointerEvent : MouseEvent;
        on.dispatchEvent(new Kind(kind, { ...at, ...more }));
      };
      const until = async (key, value) => {
        while (page.dataset[key] !== value) await new Promise((done) => setTimeout(done, 20));
      };
      const tell = (key, value) => (page.dataset[key] = value);
      until("ready", "yes").then(async () => {)" +
                     script + R"(tell("done", "yes"); });)";
    return response;
  };
  auto server = HttpServer::listen(0);
  std::array<int, 2> stop{};
  if (!server || ::pipe(stop.data()) != 0) return {};
  std::thread thread([&] { static_cast<void>(server->serve(handler, stop[0])); });
  const TemporaryFolder scratch;
  const auto out = scratch.path() / "dom.html";
  const std::string line = "HOME='" + scratch.path().string() + "' timeout 120 " + browser() +
                           " --headless --no-sandbox --disable-gpu --window-size=1400,700"
                           " --virtual-time-budget=20000 --dump-dom 'http://" +
                           server->authority() + "/key/' > '" + out.string() + "' 2>/dev/null";
  const int status = std::system(line.c_str());
  EXPECT_EQ(status, 0);
  EXPECT_EQ(::write(stop[1], "x", 1), 1);
  thread.join();
  ::close(stop[0]);
  ::close(stop[1]);
  return test::read_text(out);
}

class Page : public ::testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty()) GTEST_SKIP() << "no Chromium is installed (Debian: chromium)";
  }
};

TEST_F(Page, TurnsMovesAndComesNearer) {
  const auto dom = page_after(R"(
    const before = { ...view, at: [...view.at] };
    fire("pointerdown", space, 200, 200, { button: 0 });
    fire("pointermove", space, 260, 240, {});
    fire("pointerup", space, 260, 240, {});
    tell("turned", Math.sign(before.turn - view.turn) + " " + Math.sign(view.tilt - before.tilt));
    fire("wheel", space, 200, 200, { deltaY: -300 });
    tell("nearer", view.distance < before.distance);
    fire("pointerdown", space, 200, 200, { button: 2 });
    fire("pointermove", space, 230, 200, {});
    fire("pointerup", space, 230, 200, {});
    tell("moved", Math.hypot(...view.at.map((value, i) => value - before.at[i])) > 0.001);
    fire("pointermove", space, 300, 200, {});
    fire("dblclick", space, 200, 200, {});
    tell("again", JSON.stringify(view) === JSON.stringify(before));
  )");
  EXPECT_THAT(dom, HasSubstr("data-done=\"yes\"")) << dom.substr(0, 1000);
  EXPECT_THAT(dom, HasSubstr("data-turned=\"1 1\""));
  EXPECT_THAT(dom, HasSubstr("data-nearer=\"true\""));
  EXPECT_THAT(dom, HasSubstr("data-moved=\"true\""));
  EXPECT_THAT(dom, HasSubstr("data-again=\"true\""));
}

TEST_F(Page, EnlargesThePictureWhereTheMouseIsAndNamesNodes) {
  const auto dom = page_after(R"(
    const at = () => onPicture(placeOfPicture(picture.clientWidth, picture.clientHeight));
    const [x, y] = at()(scene.ropes[0].nodes[40]);
    fire("pointermove", picture, x, y, {});
    tell("node", byId("node").textContent);
    fire("wheel", picture, x, y, { deltaY: -900 });  // mice count whole pixels
    const [u, v] = at()(scene.ropes[0].nodes[40]);
    tell("stayed", Math.hypot(u - x, v - y) < 3 && part.times > 2);
    fire("pointermove", picture, x + 5, y, { buttons: 1, movementX: 5, movementY: 0 });
    tell("dragged", Math.abs(at()(scene.ropes[0].nodes[40])[0] - u - 5) < 0.5);
    fire("dblclick", picture, x, y, {});
    tell("whole", part.times === 1 && part.u === 0.5);
  )");
  EXPECT_THAT(dom, HasSubstr("data-done=\"yes\"")) << dom.substr(0, 1000);
  EXPECT_THAT(dom, HasSubstr("data-node=\"Node 40: x 0.034, y 0.000, z 0.500 m, sigma 2.0 mm, "
                             "measured.\""));
  EXPECT_THAT(dom, HasSubstr("data-stayed=\"true\""));
  EXPECT_THAT(dom, HasSubstr("data-dragged=\"true\""));
  EXPECT_THAT(dom, HasSubstr("data-whole=\"true\""));
}

TEST_F(Page, GoesFromFrameToFrameAndShowsSeveralRopes) {
  const auto dom = page_after(R"(
    byId("next").click();
    await until("frame", "two");
    tell("said", byId("facts").textContent);
    tell("hash", window.location.hash);
    byId("before").click();
    byId("before").click();
    await until("frame", "one");
    await until("ready", "yes");
    tell("ropes", scene.ropes.length);
    tell("below", "");
    byId("below-mask").click();
    await until("below", "mask");
    const all = lines().length;
    byId("curves-estimate").click();
    tell("fewer", lines().length < all);
    tell("draws", byId("curves-draws").disabled);
  )");
  EXPECT_THAT(dom, HasSubstr("data-done=\"yes\"")) << dom.substr(0, 1000);
  EXPECT_THAT(dom, HasSubstr("data-said=\"none&lt;b&gt;gone&lt;/b&gt;\""));  // text, not markup
  EXPECT_THAT(dom, HasSubstr("data-hash=\"#1\""));
  EXPECT_THAT(dom, HasSubstr("data-ropes=\"2\""));
  EXPECT_THAT(dom, HasSubstr("data-fewer=\"true\""));
  EXPECT_THAT(dom, HasSubstr("data-draws=\"true\""));
}

}  // namespace
}  // namespace flowdlo::view
