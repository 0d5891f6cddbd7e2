# cmake -DINPUT=page.html -DOUTPUT=page_template.cpp -P embed.cmake: a text as a C++ string literal.
# Bytes rather than a raw literal, whose length some compilers limit.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"view/page_template.hpp\"

namespace insym {
namespace {

constexpr unsigned char kBytes[] = {
${bytes}};

}  // namespace

std::string_view page_template() {
    return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

}  // namespace insym
")
