// The exit codes of the commands.
#pragma once

namespace flowdlo::support {

enum class ExitCode {
  kDone = 0,    ///< estimate: every frame has an estimate
  kFailed = 1,  ///< estimate: some frame has none; elsewhere: a file or a device failed
  kUsage = 2,   ///< wrong usage: an argument, the weights or the device asked for
};

}  // namespace flowdlo::support
