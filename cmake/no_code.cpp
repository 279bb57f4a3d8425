// What precompiled headers belong to: no source, no target.
namespace flowdlo::testing {
extern const int no_code;
const int no_code = 0;
}  // namespace flowdlo::testing
