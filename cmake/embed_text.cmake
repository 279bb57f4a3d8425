# FILE as a C++ function flowdlo::report::NAME() in OUT, in pieces short enough for every compiler.
# Bytes as escapes: file(READ) would add a newline where a piece ends.
file(SIZE "${FILE}" left)
set(at 0)
file(WRITE "${OUT}.tmp" "#include \"report/page_parts.hpp\"\n\nnamespace flowdlo::report {\n\n"
                        "std::string ${NAME}() {\n  std::string text;\n")
while(at LESS left)
  file(READ "${FILE}" piece OFFSET ${at} LIMIT 16000 HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" piece "${piece}")
  file(APPEND "${OUT}.tmp" "  text += \"${piece}\";\n")
  math(EXPR at "${at} + 16000")
endwhile()
file(APPEND "${OUT}.tmp" "  return text;\n}\n\n}  // namespace flowdlo::report\n")
file(RENAME "${OUT}.tmp" "${OUT}")
