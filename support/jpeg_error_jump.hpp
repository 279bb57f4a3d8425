// JpegErrorJump: libjpeg's own error handler ends the process; this one jumps back. Between
// setjmp(back) and its return nothing may be alive that has a destructor.
#pragma once

#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h needs it before itself

#include <jpeglib.h>

namespace flowdlo::support {

struct JpegErrorJump {
  jpeg_error_mgr base;  // first: libjpeg knows no more of it
  std::jmp_buf back;

  [[noreturn]] static void jump(j_common_ptr state) {
    std::longjmp(reinterpret_cast<JpegErrorJump*>(state->err)->back, 1);
  }

  /// Of a jpeg_compress_struct or a jpeg_decompress_struct.
  template <class State>
  void attach(State& state) {
    state.err = jpeg_std_error(&base);
    base.error_exit = jump;
  }
};

}  // namespace flowdlo::support
