// LastError: how a Result becomes a status and a message that the thread keeps.
#pragma once

#include "flowdlo/flowdlo.h"
#include "flowdlo/result.hpp"

namespace flowdlo::c_api {

[[nodiscard]] constexpr flowdlo_status status_of(ErrorCode code) {
  return static_cast<flowdlo_status>(code) + 1;
}

static_assert(status_of(ErrorCode::kBadInput) == FLOWDLO_BAD_INPUT);
static_assert(status_of(ErrorCode::kNoEvidence) == FLOWDLO_NO_EVIDENCE);
static_assert(status_of(ErrorCode::kNoPath) == FLOWDLO_NO_PATH);
static_assert(status_of(ErrorCode::kBadWeights) == FLOWDLO_BAD_WEIGHTS);
static_assert(status_of(ErrorCode::kNoDevice) == FLOWDLO_NO_DEVICE);
static_assert(status_of(ErrorCode::kDeviceLost) == FLOWDLO_DEVICE_LOST);
static_assert(status_of(ErrorCode::kIo) == FLOWDLO_IO);
static_assert(status_of(ErrorCode::kInternal) == FLOWDLO_INTERNAL);
static_assert(status_of(ErrorCode::kOutOfMemory) == FLOWDLO_OUT_OF_MEMORY);

/// The result's status. Of an error the message becomes last_error(); that needs no memory.
[[nodiscard]] flowdlo_status told(const Result<void>& result) noexcept;

/// Of this thread; empty before the first.
[[nodiscard]] const char* last_error() noexcept;

}  // namespace flowdlo::c_api
