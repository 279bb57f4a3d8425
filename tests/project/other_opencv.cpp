// What another libopencv_core may be to us: none of ours. Whoever calls it is told by the process's
// end.
#include <cstdio>
#include <cstdlib>

namespace {

[[noreturn]] void called() {
  std::fputs("another OpenCV was called\n", stderr);
  std::abort();
}

}  // namespace

extern "C" {
void fast_malloc() __asm__("_ZN2cv10fastMallocEm");
void fast_malloc() { called(); }
void fast_free() __asm__("_ZN2cv8fastFreeEPv");
void fast_free() { called(); }
void create() __asm__("_ZN2cv3Mat6createEiPKii");
void create() { called(); }
void release() __asm__("_ZN2cv3MatD1Ev");
void release() { called(); }
}
