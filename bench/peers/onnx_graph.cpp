#include "peers/onnx_graph.hpp"

#include <cstring>

namespace flowdlo::peers {
namespace {

// Field numbers and types of onnx.proto.
constexpr int kElementFloat = 1;
constexpr int kElementInt64 = 7;
constexpr int kAttributeFloat = 1;
constexpr int kAttributeInt = 2;
constexpr int kAttributeInts = 7;
constexpr int kIrVersion = 9;
constexpr int kOperatorSet = 20;

void put_varint(std::string& out, std::uint64_t value) {
  for (; value >= 128; value >>= 7U) out += static_cast<char>((value & 127U) | 128U);
  out += static_cast<char>(value);
}

void put(std::string& out, int field, std::int64_t value) {
  put_varint(out, static_cast<std::uint64_t>(field) << 3U);
  put_varint(out, static_cast<std::uint64_t>(value));
}

void put(std::string& out, int field, std::string_view bytes) {
  put_varint(out, static_cast<std::uint64_t>(field) << 3U | 2U);
  put_varint(out, bytes.size());
  out += bytes;
}

void put_float(std::string& out, int field, float value) {
  put_varint(out, static_cast<std::uint64_t>(field) << 3U | 5U);
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

std::string tensor_proto(std::string_view name, const Shape& shape, int type,
                         std::string_view bytes) {
  std::string out;
  for (const std::int64_t size : shape) put(out, 1, size);
  put(out, 2, static_cast<std::int64_t>(type));
  put(out, 8, name);
  put(out, 9, bytes);
  return out;
}

std::string value_info(std::string_view name, const Shape& shape) {
  std::string dimensions;
  for (const std::int64_t size : shape) {
    std::string dimension;
    put(dimension, 1, size);
    put(dimensions, 1, dimension);
  }
  std::string tensor;
  put(tensor, 1, std::int64_t{kElementFloat});
  put(tensor, 2, dimensions);
  std::string type;
  put(type, 1, tensor);
  std::string out;
  put(out, 1, name);
  put(out, 2, type);
  return out;
}

std::string attribute_proto(const OnnxAttribute& attribute) {
  std::string out;
  put(out, 1, attribute.name);
  if (attribute.real) {
    put_float(out, 2, attribute.number);
    put(out, 20, std::int64_t{kAttributeFloat});
    return out;
  }
  for (const std::int64_t value : attribute.integers) put(out, attribute.list ? 8 : 3, value);
  put(out, 20, std::int64_t{attribute.list ? kAttributeInts : kAttributeInt});
  return out;
}

template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

std::string OnnxGraph::fresh(std::string_view type) {
  return std::string(type) + "_" + std::to_string(values_++);
}

std::string OnnxGraph::input(const std::string& name, const Shape& shape) {
  put(inputs_, 11, value_info(name, shape));
  return name;
}

std::string OnnxGraph::tensor(const std::string& name, const Shape& shape,
                              std::span<const float> values) {
  put(initializers_, 5, tensor_proto(name, shape, kElementFloat, bytes_of(values)));
  return name;
}

std::string OnnxGraph::integers(const std::vector<std::int64_t>& values) {
  const std::string name = fresh("integers");
  const std::span<const std::int64_t> view(values);
  const Shape shape{static_cast<std::int64_t>(values.size())};
  put(initializers_, 5, tensor_proto(name, shape, kElementInt64, bytes_of(view)));
  return name;
}

std::string OnnxGraph::node(std::string_view type, std::initializer_list<std::string> inputs,
                            const std::vector<OnnxAttribute>& attributes) {
  return nodes(type, inputs, attributes, 1).front();
}

std::vector<std::string> OnnxGraph::nodes(std::string_view type,
                                          std::initializer_list<std::string> inputs,
                                          const std::vector<OnnxAttribute>& attributes,
                                          int results) {
  std::string proto;
  for (const std::string& input : inputs) put(proto, 1, input);
  std::vector<std::string> names;
  for (int i = 0; i < results; ++i) {
    names.push_back(fresh(type));
    put(proto, 2, names.back());
  }
  put(proto, 4, type);
  for (const OnnxAttribute& attribute : attributes) put(proto, 5, attribute_proto(attribute));
  put(nodes_, 1, proto);
  return names;
}

void OnnxGraph::output(const std::string& value, const std::string& name, const Shape& shape) {
  std::string proto;
  put(proto, 1, value);
  put(proto, 2, name);
  put(proto, 4, std::string_view("Identity"));
  put(nodes_, 1, proto);
  put(outputs_, 12, value_info(name, shape));
}

std::string OnnxGraph::model() const {
  std::string graph = nodes_;
  put(graph, 2, std::string_view("flowdlo"));
  graph += initializers_ + inputs_ + outputs_;
  std::string operators;
  put(operators, 1, std::string_view());
  put(operators, 2, std::int64_t{kOperatorSet});
  std::string out;
  put(out, 1, std::int64_t{kIrVersion});
  put(out, 7, graph);
  put(out, 8, operators);
  return out;
}

}  // namespace flowdlo::peers
