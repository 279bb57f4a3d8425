// The target flowdlo::weights: two files as they are, taken in by the assembler. A compiler takes
// minutes for an array of twelve million numbers. 64 bytes are what the tensors of a .fdw file are
// aligned to (weights/fdw.hpp).
#define FLOWDLO_EMBED(name, file)                    \
  asm(".pushsection .rodata.flowdlo_weights,\"a\"\n" \
      ".balign 64\n"                                 \
      ".globl flowdlo_embedded_" name                \
      "\n"                                           \
      ".hidden flowdlo_embedded_" name               \
      "\n"                                           \
      "flowdlo_embedded_" name                       \
      ":\n"                                          \
      ".incbin \"" file                              \
      "\"\n"                                         \
      ".globl flowdlo_embedded_" name                \
      "_end\n"                                       \
      ".hidden flowdlo_embedded_" name               \
      "_end\n"                                       \
      "flowdlo_embedded_" name                       \
      "_end:\n"                                      \
      ".byte 0\n"                                    \
      ".popsection\n")

FLOWDLO_EMBED("model", FLOWDLO_MODEL_FILE);
FLOWDLO_EMBED("field", FLOWDLO_FIELD_FILE);
