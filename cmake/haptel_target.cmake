# One INTERFACE target carries the flags that every target of the project shares; nothing is set globally.
add_library(haptel_flags INTERFACE)
target_compile_features(haptel_flags INTERFACE cxx_std_20)
target_include_directories(haptel_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(haptel_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Werror=switch -Werror=return-type
    # The height beside a gradient must equal the height alone, and a replay the recording, bit for bit:
    # the compiler may not fuse a*b+c where it likes.
    -ffp-contract=off)
# Two findings that are about a file, and wrong about a folder compiled as one.
if(HAPTEL_UNITY)
    target_compile_options(haptel_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
else()
    target_compile_options(haptel_flags INTERFACE -Wshadow)
endif()
if(HAPTEL_WERROR)
    target_compile_options(haptel_flags INTERFACE -Werror)
    # g++ makes these up about its own string header once it inlines; clang and the sanitizers find the true ones.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(haptel_flags INTERFACE
            -Wno-error=array-bounds -Wno-error=restrict -Wno-error=stringop-overflow -Wno-error=maybe-uninitialized)
    endif()
endif()
if(HAPTEL_SANITIZE)
    target_compile_options(haptel_flags INTERFACE
        -fsanitize=${HAPTEL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
        # g++ sees ghosts of these in code that it has instrumented.
        $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-conversion>)
    # Asio has fences, which ThreadSanitizer does not know; where it stands one thread at a time uses it.
    if(HAPTEL_SANITIZE MATCHES "thread" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(haptel_flags INTERFACE -Wno-tsan)
    endif()
    target_link_options(haptel_flags INTERFACE -fsanitize=${HAPTEL_SANITIZE})
    # Each place that is checked has pointers to what is told of it: over a million for the loader to move at each start
    # of the command, which its tests start hundreds of times.
    if(HAPTEL_SANITIZE MATCHES "address")
        target_link_options(haptel_flags INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
    endif()
endif()

# What most files include, read once for each target: it is half of a file's time in the compiler. Each file still
# includes what it uses (-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without).
set(haptel_precompiled <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <optional> <span>
    <string> <string_view> <unordered_map> <utility> <variant> <vector>)

# With HAPTEL_UNITY the compiler sees the files of a folder as one, and reads their headers once. Names in the anonymous
# namespaces of a folder must differ then: two that are equal are one thing written twice, or two that deserve better
# names. A folder of more files than the second argument says is cut into even parts.
function(haptel_by_folders name)
    set(most ${ARGN})
    get_target_property(sources ${name} SOURCES)
    set(folders)
    foreach(source ${sources})
        cmake_path(GET source PARENT_PATH folder)
        string(REPLACE ".." "up" folder "${folder}")
        if(NOT IS_ABSOLUTE "${source}") # those are generated
            list(APPEND folders "${folder}/")
            list(APPEND "files_${folder}/" ${source})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES folders)
    foreach(folder ${folders})
        list(LENGTH "files_${folder}" count)
        set(parts 1)
        if(most)
            math(EXPR parts "(${count} + ${most} - 1) / ${most}")
        endif()
        string(REGEX REPLACE "/$" "" group "folder_${folder}")
        set(done 0)
        foreach(source ${files_${folder}})
            math(EXPR part "${done} * ${parts} / ${count}")
            math(EXPR done "${done} + 1")
            if(part GREATER 0)
                set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${group}_${part}")
            else()
                set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${group}")
            endif()
        endforeach()
    endforeach()
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${HAPTEL_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

# haptel_library(name SOURCES... ) makes the static library of one folder.
function(haptel_library name)
    add_library(${name} STATIC ${ARGN})
    target_link_libraries(${name} PUBLIC haptel_flags)
    target_precompile_headers(${name} PRIVATE ${haptel_precompiled})
    haptel_by_folders(${name})
endfunction()
