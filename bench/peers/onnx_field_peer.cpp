#include <cstdio>

#include "field/channel.hpp"
#include "peers/field_peers.hpp"
#include "peers/onnx_graph.hpp"
#include "peers/onnx_runtime.hpp"

namespace flowdlo::peers {
namespace {

constexpr std::int64_t kSide = field::kFold;
constexpr std::int64_t kFold = kSide * kSide;  // pixels of a place

/// The network's layers over a graph.
class Writer {
 public:
  explicit Writer(const weights::FieldWeights& weights) : weights_(weights) {}

  OnnxGraph& graph() { return graph_; }

  /// With as many inputs and outputs as the network has, without those that fill up.
  std::string convolve(const std::string& name, const std::string& x, int out, int in) {
    const auto& stored = weights_.at(name + ".weight");
    const auto taps = static_cast<std::size_t>(stored.shape[1]);
    const auto columns = static_cast<std::size_t>(stored.shape[2]);
    std::vector<float> values;
    for (std::size_t o = 0; o < static_cast<std::size_t>(out); ++o) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(in); ++i) {
        for (std::size_t tap = 0; tap < taps; ++tap) {
          values.push_back(stored.values[(o * taps + tap) * columns + i]);
        }
      }
    }
    const std::int64_t side = taps == 1 ? 1 : 3;
    const std::int64_t pad = side / 2;
    const std::string weight = graph_.tensor(name + ".weight", {out, in, side, side}, values);
    const std::string bias = graph_.tensor(
        name + ".bias", {out},
        std::span(weights_.at(name + ".bias").values).first(static_cast<std::size_t>(out)));
    return graph_.node("Conv", {x, weight, bias},
                       {{.name = "kernel_shape", .integers = {side, side}, .list = true},
                        {.name = "pads", .integers = {pad, pad, pad, pad}, .list = true}});
  }
  std::string square(const std::string& name, const std::string& x, int out, int in) {
    return graph_.node("Relu", {convolve(name, x, out, in)});
  }
  std::string pool(const std::string& x) {
    return graph_.node("MaxPool", {x},
                       {{.name = "kernel_shape", .integers = {2, 2}, .list = true},
                        {.name = "strides", .integers = {2, 2}, .list = true}});
  }
  /// The nearest value, which is what the operator does unless told otherwise.
  std::string twice(const std::string& x) {
    const std::vector<float> scales{1, 1, 2, 2};
    const std::string by = graph_.tensor("twice_" + x, {4}, scales);
    return graph_.node("Resize", {x, "", by});
  }
  std::string add(const std::string& a, const std::string& b) { return graph_.node("Add", {a, b}); }

  /// Logits of channels that lie between 0 and 1 as such, the others as they are.
  std::string likely(const std::string& places) {
    auto c = graph_.nodes("Split", {places},
                          {{.name = "axis", .integers = {1}},
                           {.name = "num_outputs", .integers = {field::kChannels}}},
                          field::kChannels);
    for (const std::size_t k :
         {field::kCentre, field::kTip, field::kUnder, field::kRope, field::kEdge}) {
      c[k] = graph_.node("Sigmoid", {c[k]});
    }
    static_assert(field::kChannels == 10);
    return graph_.node("Concat", {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], c[9]},
                       {{.name = "axis", .integers = {1}}});
  }

  std::string turned(const std::string& x, const Shape& from, const Shape& order, const Shape& to) {
    const auto split = graph_.node("Reshape", {x, graph_.integers(from)});
    const auto mixed =
        graph_.node("Transpose", {split}, {{.name = "perm", .integers = order, .list = true}});
    return graph_.node("Reshape", {mixed, graph_.integers(to)});
  }

 private:
  const weights::FieldWeights& weights_;
  OnnxGraph graph_;
};

/// planes [1, 7, h, w] to said [1, 10, h, w].
std::string onnx_field(const weights::FieldWeights& weights, std::int64_t h, std::int64_t w) {
  Writer write(weights);
  OnnxGraph& graph = write.graph();
  const auto [fine_width, middle_width, coarse_width] = weights.sizes;
  const std::int64_t rows = h / kSide;
  const std::int64_t columns = w / kSide;
  const auto planes = graph.input("planes", {1, field::kPlanes, h, w});
  const auto x = write.turned(planes, {1, field::kPlanes, rows, kSide, columns, kSide},
                              {0, 1, 3, 5, 2, 4}, {1, kFold * field::kPlanes, rows, columns});
  const auto fine = write.square("down_fine.1",
                                 write.square("down_fine.0", x, fine_width, kFold * field::kPlanes),
                                 fine_width, fine_width);
  const auto middle = write.square(
      "down_middle.1", write.square("down_middle.0", write.pool(fine), middle_width, fine_width),
      middle_width, middle_width);
  auto coarse = write.square("coarse.0", write.pool(middle), coarse_width, middle_width);
  coarse = write.square("coarse.1", coarse, coarse_width, coarse_width);
  coarse = write.square("coarse.2", coarse, coarse_width, coarse_width);
  const auto up = write.twice(write.convolve("to_middle", coarse, middle_width, coarse_width));
  const auto half = write.square(
      "up_middle.1", write.square("up_middle.0", write.add(middle, up), middle_width, middle_width),
      middle_width, middle_width);
  const auto finer = write.twice(write.convolve("to_fine", half, fine_width, middle_width));
  const auto whole = write.square(
      "up_fine.1", write.square("up_fine.0", write.add(fine, finer), fine_width, fine_width),
      fine_width, fine_width);
  const auto places = write.convolve("head", whole, kFold * field::kChannels, fine_width);
  const auto said =
      write.turned(write.likely(places), {1, field::kChannels, kSide, kSide, rows, columns},
                   {0, 1, 4, 2, 5, 3}, {1, field::kChannels, h, w});
  graph.output(said, "said", {1, field::kChannels, h, w});
  return graph.model();
}

class OnnxFieldPeer final : public FieldPeer {
 public:
  OnnxFieldPeer(const FieldProblem& problem, std::string version, OnnxSession session)
      : problem_(problem),
        version_(std::move(version)),
        session_(std::move(session)),
        planes_(problem.planes),
        said_(problem.input.total() * field::kChannels) {}

  [[nodiscard]] std::string name() const override { return "ONNX Runtime " + version_; }

  void see(std::vector<float>* said) override {
    const Shape size{1, 0, problem_.height(), problem_.width()};
    const auto of = [&](std::int64_t channels) {
      Shape shape = size;
      shape[1] = channels;
      return shape;
    };
    const OnnxTensor in{"planes", of(field::kPlanes), planes_};
    const OnnxTensor out{"said", of(field::kChannels), said_};
    const auto ran = session_.run(std::span(&in, 1), std::span(&out, 1));
    if (!ran) std::fprintf(stderr, "%s\n", ran.error().message.c_str());
    if (said != nullptr) *said = said_;
  }

 private:
  const FieldProblem& problem_;
  std::string version_;
  OnnxSession session_;
  std::vector<float> planes_;
  std::vector<float> said_;
};

}  // namespace

Result<std::unique_ptr<FieldPeer>> onnx_field_peer(const FieldProblem& problem,
                                                   const std::filesystem::path& library) {
  const auto runtime = OnnxRuntime::open(library);
  if (!runtime) return runtime.error();
  auto session = OnnxSession::create(
      *runtime, onnx_field(*problem.weights, problem.height(), problem.width()), problem.threads);
  if (!session) return session.error();
  return std::unique_ptr<FieldPeer>(
      std::make_unique<OnnxFieldPeer>(problem, (*runtime)->version(), *std::move(session)));
}

}  // namespace flowdlo::peers
