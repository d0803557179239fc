# cmake -DOUTPUT=FILE -DTEXTS=FILE;FILE… -P embed_texts.cmake: texts as a C++ function that gives
# them by name (view/page_sources.h). A program carries its page along; no generated file is kept.
set(cases "")
foreach(text IN LISTS TEXTS)
    get_filename_component(name ${text} NAME)
    # Brackets and semicolons mean something to CMake's lists: the bytes are kept as a string.
    file(READ ${text} content)
    string(APPEND cases "    if (name == \"${name}\")\n        return R\"~~~(${content})~~~\";\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from view/page by cmake/embed_texts.cmake.\n#include \"view/page_sources.h\"\n
namespace tyndall::view {\n\nstd::string_view page_source(std::string_view name) {\n${cases}    return {};\n}\n
}  // namespace tyndall::view\n")
