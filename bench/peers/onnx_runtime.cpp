#include "peers/onnx_runtime.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <utility>

namespace flowdlo::peers {
namespace {

// Positions in the table of functions (struct OrtApi).
enum Position : std::size_t {
  kGetErrorMessage = 2,
  kCreateEnv = 3,
  kCreateSessionFromArray = 8,
  kRun = 9,
  kCreateSessionOptions = 10,
  kSetGraphOptimizationLevel = 23,
  kSetIntraOpThreads = 24,
  kCreateTensorWithData = 49,
  kCreateCpuMemoryInfo = 69,
  kReleaseStatus = 93,
  kReleaseSession = 95,
  kReleaseValue = 96,
  kReleaseSessionOptions = 100,
};
constexpr std::uint32_t kInterfaceVersion = 12;  // the oldest that has all of these
constexpr int kLogErrors = 3;
constexpr int kEveryOptimization = 99;
constexpr int kArenaAllocator = 1;
constexpr int kDefaultMemory = 0;
constexpr int kElementFloat = 1;

struct Base {
  const void* const* (*table)(std::uint32_t version);
  const char* (*version)();
};

template <class... Arguments>
void* call(const void* const* table, Position position, Arguments... arguments) {
  using Function = void* (*)(Arguments...);
  return reinterpret_cast<Function>(const_cast<void*>(table[position]))(arguments...);
}

/// What a status says; an absent status is success.
Result<void> check(const void* const* table, void* status) {
  if (status == nullptr) return {};
  const auto* text = static_cast<const char*>(call(table, kGetErrorMessage, status));
  Error error{ErrorCode::kInternal, fmt::format("ONNX Runtime: {}", text)};
  call(table, kReleaseStatus, status);
  return error;
}

}  // namespace

Result<std::shared_ptr<OnnxRuntime>> OnnxRuntime::open(const std::filesystem::path& library) {
  void* handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays open
  void* entry = handle != nullptr ? ::dlsym(handle, "OrtGetApiBase") : nullptr;
  if (entry == nullptr) return Error{ErrorCode::kIo, ::dlerror()};
  const auto* base = reinterpret_cast<const Base* (*)()>(entry)();
  std::shared_ptr<OnnxRuntime> runtime(new OnnxRuntime());
  runtime->version_ = base->version();
  runtime->table_ = base->table(kInterfaceVersion);
  if (runtime->table_ == nullptr) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected interface version {}, got ONNX Runtime "
                                             "{}; name a newer library",
                                             library.string(), kInterfaceVersion, base->version())};
  }
  const auto* table = runtime->table_;
  if (auto made =
          check(table, call(table, kCreateEnv, kLogErrors, "peers", &runtime->environment_));
      !made) {
    return made.error();
  }
  if (auto made = check(table, call(table, kCreateCpuMemoryInfo, kArenaAllocator, kDefaultMemory,
                                    &runtime->memory_));
      !made) {
    return made.error();
  }
  return runtime;
}

Result<OnnxSession> OnnxSession::create(std::shared_ptr<OnnxRuntime> runtime,
                                        const std::string& model, int threads) {
  const auto* table = runtime->table_;
  void* options = nullptr;
  void* session = nullptr;
  auto done = check(table, call(table, kCreateSessionOptions, &options));
  if (done)
    done = check(table, call(table, kSetGraphOptimizationLevel, options, kEveryOptimization));
  if (done) done = check(table, call(table, kSetIntraOpThreads, options, threads));
  if (done) {
    done = check(table, call(table, kCreateSessionFromArray, runtime->environment_, model.data(),
                             model.size(), options, &session));
  }
  if (options != nullptr) call(table, kReleaseSessionOptions, options);
  if (!done) return done.error();
  return OnnxSession(std::move(runtime), session);
}

Result<void> OnnxSession::run(std::span<const OnnxTensor> inputs,
                              std::span<const OnnxTensor> outputs) const {
  const auto* table = runtime_->table_;
  std::vector<const char*> names[2];
  std::vector<void*> values[2];
  Result<void> done;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    for (const OnnxTensor& tensor : side == 0 ? inputs : outputs) {
      void* value = nullptr;
      if (done) {
        done = check(table, call(table, kCreateTensorWithData, runtime_->memory_,
                                 tensor.values.data(), tensor.values.size_bytes(),
                                 tensor.shape.data(), tensor.shape.size(), kElementFloat, &value));
      }
      names[side].push_back(tensor.name);
      values[side].push_back(value);
    }
  }
  if (done) {
    done = check(table, call(table, kRun, session_, static_cast<void*>(nullptr), names[0].data(),
                             values[0].data(), values[0].size(), names[1].data(), names[1].size(),
                             values[1].data()));
  }
  for (const auto& side : values) {
    for (void* value : side) {
      if (value != nullptr) call(table, kReleaseValue, value);
    }
  }
  return done;
}

OnnxSession::OnnxSession(std::shared_ptr<OnnxRuntime> runtime, void* session)
    : runtime_(std::move(runtime)), session_(session) {}

OnnxSession::OnnxSession(OnnxSession&& other) noexcept
    : runtime_(std::move(other.runtime_)), session_(std::exchange(other.session_, nullptr)) {}

OnnxSession::~OnnxSession() {
  if (session_ != nullptr) call(runtime_->table_, kReleaseSession, session_);
}

}  // namespace flowdlo::peers
