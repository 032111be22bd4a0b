# cmake -DOUT=library_text.cpp -DNAME=library -DFILES=a.haptel;b.haptel -P embed.cmake: the files as raw strings in one C++
# source, which the function NAME gives.
# Literals are cut into pieces, because compilers need accept only 64 KiB in one.
set(text "// Made by embed.cmake.\n#include \"stdlib/stdlib.h\"\n\nnamespace haptel::stdlib {\n\nstd::span<const LibraryFile> ${NAME}()\n{\n    static constexpr LibraryFile files[] = {\n")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    file(READ ${file} content)
    string(LENGTH "${content}" length)
    string(APPEND text "        {\"${name}\",\n")
    set(at 0)
    while(at LESS length)
        string(SUBSTRING "${content}" ${at} 12000 piece)
        string(APPEND text "R\"haptel(${piece})haptel\"\n")
        math(EXPR at "${at} + 12000")
    endwhile()
    string(APPEND text "        },\n")
endforeach()
string(APPEND text "    };\n    return files;\n}\n\n} // namespace haptel::stdlib\n")
file(WRITE ${OUT} "${text}")
