# FILE as a C++ function SPACE::NAME() in OUT, which HEADER declares, in pieces short enough for every
# compiler. Bytes as escapes: file(READ) would add a newline where a piece ends.
file(SIZE "${FILE}" left)
set(at 0)
file(WRITE "${OUT}.tmp" "#include \"${HEADER}\"\n\nnamespace ${SPACE} {\n\n"
                        "std::string ${NAME}() {\n  std::string text;\n")
while(at LESS left)
  file(READ "${FILE}" piece OFFSET ${at} LIMIT 16000 HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" piece "${piece}")
  file(APPEND "${OUT}.tmp" "  text += \"${piece}\";\n")
  math(EXPR at "${at} + 16000")
endwhile()
file(APPEND "${OUT}.tmp" "  return text;\n}\n\n}  // namespace ${SPACE}\n")
file(RENAME "${OUT}.tmp" "${OUT}")
