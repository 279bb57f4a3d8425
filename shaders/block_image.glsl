// What shaders that go over an image in blocks share; see ops/program.hpp. A row of the map has
// twelve entries: entry 3 (dy + 1) + (dx + 1) is the block that lies there, or -1.
const int kMapEntries = 12;
const int kOwn = 4;  // the entry of the block itself: -1 where it is not in use
