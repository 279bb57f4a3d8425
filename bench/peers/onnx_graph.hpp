// OnnxGraph: writes an ONNX model, the few parts of its protobuf that a transformer needs.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flowdlo::peers {

using Shape = std::vector<std::int64_t>;

struct OnnxAttribute {
  std::string name;
  std::vector<std::int64_t> integers;  ///< one, or a list where `list`
  bool list = false;
  bool real = false;
  float number = 0;
};

/// Values are named by strings; node() returns the name of its result.
class OnnxGraph {
 public:
  std::string input(const std::string& name, const Shape& shape);
  std::string tensor(const std::string& name, const Shape& shape, std::span<const float> values);
  std::string integers(const std::vector<std::int64_t>& values);
  std::string node(std::string_view type, std::initializer_list<std::string> inputs,
                   const std::vector<OnnxAttribute>& attributes = {});
  /// Several results.
  std::vector<std::string> nodes(std::string_view type, std::initializer_list<std::string> inputs,
                                 const std::vector<OnnxAttribute>& attributes, int results);
  void output(const std::string& value, const std::string& name, const Shape& shape);

  /// The model's bytes, operator set 20.
  [[nodiscard]] std::string model() const;

 private:
  std::string fresh(std::string_view type);

  std::string inputs_;  // encoded fields of GraphProto
  std::string outputs_;
  std::string initializers_;
  std::string nodes_;
  int values_ = 0;
};

}  // namespace flowdlo::peers
