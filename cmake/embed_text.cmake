# cmake [-DINPUT=FILE] -DOUTPUT=FILE.cpp -P embed_text.cmake
# Writes the viewer's page as a string of the program; without INPUT an empty one.
set(text "")
if(INPUT)
  file(READ "${INPUT}" text)
endif()
string(LENGTH "${text}" length)
set(literals "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 16000 piece)
  string(APPEND literals "R\"~~~(${piece})~~~\"\n")
  math(EXPR at "${at} + 16000")
endwhile()
file(WRITE "${OUTPUT}" "#include \"strake/report/viewer.h\"

std::string_view strake::report::viewer_page() {
  using std::string_view_literals::operator\"\"sv;
  return ${literals}\"\"sv;
}
")
