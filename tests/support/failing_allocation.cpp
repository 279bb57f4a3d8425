#include "support/failing_allocation.hpp"

#include <link.h>
#include <unwind.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FLOWDLO_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FLOWDLO_SANITIZED
#endif
#endif

namespace {

using flowdlo::testing::Fails;

std::atomic<bool> armed = false;
std::atomic<int> mode = 0;
std::atomic<long> number = 0;
std::atomic<long> counted = 0;
std::atomic<long> failures = 0;
thread_local bool looking = false;  // the unwinder may allocate as well

struct Range {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
};

constexpr int kMostRanges = 512;
std::array<Range, kMostRanges> linked;  // code of what the process was started with
int linked_count = 0;

int add_ranges(dl_phdr_info* info, std::size_t, void*) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    const bool code = header.p_type == PT_LOAD && (header.p_flags & PF_X) != 0;
    if (!code || linked_count == kMostRanges) continue;
    const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
    linked[static_cast<std::size_t>(linked_count++)] = {begin, begin + header.p_memsz};
  }
  return 0;
}

bool is_linked(std::uintptr_t address) {
  for (int i = 0; i < linked_count; ++i) {
    const Range& range = linked[static_cast<std::size_t>(i)];
    if (address >= range.begin && address < range.end) return true;
  }
  return false;
}

_Unwind_Reason_Code look(_Unwind_Context* context, void* foreign) {
  const auto address = static_cast<std::uintptr_t>(_Unwind_GetIP(context));
  if (address == 0 || is_linked(address)) return _URC_NO_REASON;
  *static_cast<bool*>(foreign) = true;
  return _URC_END_OF_STACK;
}

/// Whether a library that was opened later stands anywhere in the call.
bool is_foreign() {
  looking = true;
  bool foreign = false;
  _Unwind_Backtrace(look, &foreign);
  looking = false;
  return foreign;
}

bool fails_now(void* caller) {
  if (!armed.load(std::memory_order_relaxed) || looking) return false;
  if (!is_linked(reinterpret_cast<std::uintptr_t>(caller))) return false;
  const long mine = ++counted;
  const auto fails = static_cast<Fails>(mode.load(std::memory_order_relaxed));
  if (fails == Fails::kNever || mine < number) return false;
  if ((fails == Fails::kOnce && failures > 0) || is_foreign()) return false;
  ++failures;
  return true;
}

/// Before main: what is opened later is none of it.
__attribute__((constructor)) void list_what_is_linked() {
  dl_iterate_phdr(add_ranges, nullptr);
  (void)is_foreign();  // the unwinder's own first allocations
}

/// Memory of the system, past the functions that are replaced below.
void* taken(std::size_t bytes, std::size_t alignment);

void* new_memory(std::size_t bytes, std::size_t alignment, void* caller) {
  if (fails_now(caller)) throw std::bad_alloc();
  if (void* memory = taken(bytes > 0 ? bytes : 1, alignment)) return memory;
  throw std::bad_alloc();
}

void* new_memory_or_none(std::size_t bytes, std::size_t alignment, void* caller) noexcept {
  return fails_now(caller) ? nullptr : taken(bytes > 0 ? bytes : 1, alignment);
}

}  // namespace

#define FLOWDLO_CALLER __builtin_return_address(0)

void* operator new(std::size_t bytes) { return new_memory(bytes, 0, FLOWDLO_CALLER); }
void* operator new[](std::size_t bytes) { return new_memory(bytes, 0, FLOWDLO_CALLER); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return new_memory(bytes, static_cast<std::size_t>(alignment), FLOWDLO_CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return new_memory(bytes, static_cast<std::size_t>(alignment), FLOWDLO_CALLER);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return new_memory_or_none(bytes, 0, FLOWDLO_CALLER);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return new_memory_or_none(bytes, 0, FLOWDLO_CALLER);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return new_memory_or_none(bytes, static_cast<std::size_t>(alignment), FLOWDLO_CALLER);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
  return new_memory_or_none(bytes, static_cast<std::size_t>(alignment), FLOWDLO_CALLER);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

#ifdef FLOWDLO_SANITIZED

namespace {

void* taken(std::size_t bytes, std::size_t alignment) {
  if (alignment == 0) return std::malloc(bytes);
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

}  // namespace

#else

// glibc's own names for what is replaced here.
extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
  if (!fails_now(FLOWDLO_CALLER)) return __libc_malloc(bytes);
  errno = ENOMEM;
  return nullptr;
}
void* calloc(std::size_t count, std::size_t bytes) {
  if (!fails_now(FLOWDLO_CALLER)) return __libc_calloc(count, bytes);
  errno = ENOMEM;
  return nullptr;
}
void* realloc(void* memory, std::size_t bytes) {
  if (bytes == 0 || !fails_now(FLOWDLO_CALLER)) return __libc_realloc(memory, bytes);
  errno = ENOMEM;
  return nullptr;
}
void* memalign(std::size_t alignment, std::size_t bytes) {
  if (!fails_now(FLOWDLO_CALLER)) return __libc_memalign(alignment, bytes);
  errno = ENOMEM;
  return nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  if (!fails_now(FLOWDLO_CALLER)) return __libc_memalign(alignment, bytes);
  errno = ENOMEM;
  return nullptr;
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  void* const got = fails_now(FLOWDLO_CALLER) ? nullptr : __libc_memalign(alignment, bytes);
  if (got == nullptr) return ENOMEM;
  *memory = got;
  return 0;
}
}

namespace {

void* taken(std::size_t bytes, std::size_t alignment) {
  return alignment == 0 ? __libc_malloc(bytes) : __libc_memalign(alignment, bytes);
}

}  // namespace

#endif

namespace flowdlo::testing {

FailingAllocation::FailingAllocation(Fails fails, long which) {
  mode = static_cast<int>(fails);
  number = which;
  counted = 0;
  failures = 0;
  armed = true;
}

FailingAllocation::~FailingAllocation() { armed = false; }

long FailingAllocation::count() { return counted; }
long FailingAllocation::failed() { return failures; }

}  // namespace flowdlo::testing
