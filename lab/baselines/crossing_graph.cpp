#include "baselines/crossing_graph.hpp"

#include <algorithm>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "baselines/zhang_suen.hpp"

namespace flowdlo::baselines {
namespace {

constexpr int kClusterRadius_px = 2;
constexpr double kAttached_px = 3;  // from a stroke's end to a junction pixel
constexpr double kSpurInRadii = 2;
constexpr double kFlatXInRadii = 10;  // two Y junctions nearer than this are one X

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Labels of junction pixels: those within 2 px of one another share one, from 0 on.
cv::Mat clusters(const cv::Mat& junctions, int& count) {
  const int size = 2 * kClusterRadius_px + 1;
  cv::Mat grown;
  cv::dilate(junctions, grown, cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  cv::Mat labels;
  count = cv::connectedComponents(grown, labels) - 1;
  labels -= 1;
  labels.setTo(-1, junctions == 0);
  return labels;
}

// The crossing whose junction pixel is nearest to `end`; -1: none near.
int crossing_near(const cv::Point2f& end, const cv::Mat& labels) {
  const int reach = static_cast<int>(kAttached_px);
  double nearest = kAttached_px;
  int found = -1;
  for (int dv = -reach; dv <= reach; ++dv) {
    for (int du = -reach; du <= reach; ++du) {
      const int v = cvRound(end.y) + dv;
      const int u = cvRound(end.x) + du;
      if (v < 0 || u < 0 || v >= labels.rows || u >= labels.cols) continue;
      const int label = labels.at<int>(v, u);
      const double away = std::hypot(dv, du);
      if (label < 0 || away >= nearest) continue;
      nearest = away;
      found = label;
    }
  }
  return found;
}

void find_places(const cv::Mat& labels, int count, CrossingGraph& graph) {
  graph.places.assign(at(count), {0, 0});
  std::vector<float> pixels(at(count), 0);
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      const int label = labels.at<int>(v, u);
      if (label < 0) continue;
      graph.places[at(label)] += cv::Point2f(static_cast<float>(u), static_cast<float>(v));
      pixels[at(label)] += 1;
    }
  }
  for (int i = 0; i < count; ++i) graph.places[at(i)] /= std::max(1.0F, pixels[at(i)]);
}

void remove(CrossingGraph& graph, std::size_t stroke) {
  graph.strokes[stroke].clear();
  graph.crossing_of[2 * stroke] = graph.crossing_of[2 * stroke + 1] = -1;
}

// Joins two strokes that are all that is left at a crossing, through its place.
void join(CrossingGraph& graph, int a, int b, const cv::Point2f& place) {
  Stroke first = graph.strokes[at(a / 2)];
  Stroke second = graph.strokes[at(b / 2)];
  const int front = graph.crossing_of[at(a ^ 1)];
  const int back = graph.crossing_of[at(b ^ 1)];
  if (a % 2 == 0) std::reverse(first.begin(), first.end());
  if (b % 2 == 1) std::reverse(second.begin(), second.end());
  first.push_back(place);
  first.insert(first.end(), second.begin(), second.end());
  remove(graph, at(b / 2));
  graph.strokes[at(a / 2)] = std::move(first);
  graph.crossing_of[at(a / 2) * 2] = front;
  graph.crossing_of[at(a / 2) * 2 + 1] = back;
}

// What lies between the pixels of one junction is no branch.
void remove_insides(CrossingGraph& graph) {
  for (std::size_t stroke = 0; stroke < graph.strokes.size(); ++stroke) {
    const int crossing = graph.crossing_of[2 * stroke];
    const bool inside = crossing >= 0 && crossing == graph.crossing_of[2 * stroke + 1];
    if (inside && length_px(graph.strokes[stroke]) < kSpurInRadii * graph.radius_px) {
      remove(graph, stroke);
    }
  }
}

bool remove_one_spur(CrossingGraph& graph) {
  for (std::size_t stroke = 0; stroke < graph.strokes.size(); ++stroke) {
    if (graph.strokes[stroke].empty()) continue;
    const bool free =
        (graph.crossing_of[2 * stroke] < 0) != (graph.crossing_of[2 * stroke + 1] < 0);
    if (!free || length_px(graph.strokes[stroke]) >= kSpurInRadii * graph.radius_px) continue;
    remove(graph, stroke);
    return true;
  }
  return false;
}

void join_passages(CrossingGraph& graph) {
  for (int i = 0; i < static_cast<int>(graph.places.size()); ++i) {
    const auto ends = graph.ends_at(i);
    if (ends.size() == 2 && ends[0] / 2 != ends[1] / 2)
      join(graph, ends[0], ends[1], graph.places[at(i)]);
  }
}

// A short stroke between two Y junctions is the overlap of two ropes at a flat angle.
void merge_flat_crossings(CrossingGraph& graph) {
  for (std::size_t stroke = 0; stroke < graph.strokes.size(); ++stroke) {
    const int from = graph.crossing_of[2 * stroke];
    const int to = graph.crossing_of[2 * stroke + 1];
    if (from < 0 || to < 0 || from == to) continue;
    if (graph.ends_at(from).size() != 3 || graph.ends_at(to).size() != 3) continue;
    if (length_px(graph.strokes[stroke]) > kFlatXInRadii * graph.radius_px) continue;
    remove(graph, stroke);
    for (int& crossing : graph.crossing_of) crossing = crossing == to ? from : crossing;
    graph.places[at(from)] = 0.5F * (graph.places[at(from)] + graph.places[at(to)]);
  }
}

}  // namespace

std::vector<int> CrossingGraph::ends_at(int crossing) const {
  std::vector<int> ends;
  for (std::size_t i = 0; i < crossing_of.size(); ++i) {
    if (crossing_of[i] == crossing) ends.push_back(static_cast<int>(i));
  }
  return ends;
}

CrossingGraph crossing_graph(const cv::Mat& mask) {
  const cv::Mat skeleton = zhang_suen(mask);
  const cv::Mat junctions = junction_pixels(skeleton);
  CrossingGraph graph;
  graph.strokes = strokes_of(skeleton, junctions);
  cv::Mat away;
  cv::distanceTransform(mask != 0, away, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::minMaxLoc(away, nullptr, &graph.radius_px, nullptr, nullptr, skeleton);
  int count = 0;
  const cv::Mat labels = clusters(junctions, count);
  find_places(labels, count, graph);
  for (const Stroke& stroke : graph.strokes) {
    graph.crossing_of.push_back(crossing_near(stroke.front(), labels));
    graph.crossing_of.push_back(crossing_near(stroke.back(), labels));
  }
  remove_insides(graph);
  while (remove_one_spur(graph)) join_passages(graph);
  join_passages(graph);
  merge_flat_crossings(graph);
  return graph;
}

}  // namespace flowdlo::baselines
