// OnnxRuntime: the few entries of ONNX Runtime's C interface that a session needs, opened at run
// time. Its table of functions only ever grows at the end, so that positions are fixed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::peers {

/// A tensor of f32 in the caller's memory.
struct OnnxTensor {
  const char* name;
  std::vector<std::int64_t> shape;
  std::span<float> values;
};

class OnnxRuntime {
 public:
  /// `library` is libonnxruntime.so. Fails with kIo when it cannot be opened or is no such library.
  [[nodiscard]] static Result<std::shared_ptr<OnnxRuntime>> open(
      const std::filesystem::path& library);

  [[nodiscard]] const std::string& version() const { return version_; }

 private:
  friend class OnnxSession;
  OnnxRuntime() = default;

  const void* const* table_ = nullptr;
  void* environment_ = nullptr;
  void* memory_ = nullptr;
  std::string version_;
};

/// One model, made ready with every graph optimisation, on `threads` threads.
class OnnxSession {
 public:
  [[nodiscard]] static Result<OnnxSession> create(std::shared_ptr<OnnxRuntime> runtime,
                                                  const std::string& model, int threads);
  /// Results are written into the outputs' memory.
  [[nodiscard]] Result<void> run(std::span<const OnnxTensor> inputs,
                                 std::span<const OnnxTensor> outputs) const;

  OnnxSession(OnnxSession&& other) noexcept;
  OnnxSession& operator=(OnnxSession&&) = delete;
  ~OnnxSession();

 private:
  OnnxSession(std::shared_ptr<OnnxRuntime> runtime, void* session);

  std::shared_ptr<OnnxRuntime> runtime_;
  void* session_;
};

}  // namespace flowdlo::peers
