# cmake -DOUTPUT=FILE -DHEADER=INCLUDE -DFUNCTION=NAMESPACE::NAME -DTEXTS=FILE;FILE… -P embed_texts.cmake:
# texts as a C++ function, declared in HEADER, that gives them by name. A program carries its page and its
# templates along; no generated file is kept.
set(cases "")
foreach(text IN LISTS TEXTS)
    get_filename_component(name ${text} NAME)
    # Brackets and semicolons mean something to CMake's lists: the bytes are kept as a string.
    file(READ ${text} content)
    string(APPEND cases "    if (name == \"${name}\")\n        return R\"~~~(${content})~~~\";\n")
endforeach()
string(REGEX REPLACE "::[^:]*$" "" namespace ${FUNCTION})
string(REGEX REPLACE "^.*::" "" function ${FUNCTION})
file(WRITE ${OUTPUT} "// Made by cmake/embed_texts.cmake.\n#include \"${HEADER}\"\n
namespace ${namespace} {\n\nstd::string_view ${function}(std::string_view name) {\n${cases}    return {};\n}\n
}  // namespace ${namespace}\n")
