# haptel_add_textures(TARGET FILE.haptel... [ISA baseline|avx2|avx512|aarch64...] [PRECISION f64|mixed|f32] [EMIT object|c])
#
# Compiles textures when the target is built, and makes them a part of it: the target includes "FILE.h" and calls what it
# declares, without a compiler at run time. EMIT c makes C text in place of machine code, which the target's own compiler
# then compiles: for processors that Haptel makes no code for. Of several sets behind ISA the largest that the processor
# has is chosen when the program is loaded. What a file imports counts as its source. The command is that of this build,
# or else the one that is installed.
function(haptel_add_textures target)
    cmake_parse_arguments(ARG "" "PRECISION;EMIT" "ISA" ${ARGN})
    set(emit object)
    if(ARG_EMIT)
        set(emit ${ARG_EMIT})
    endif()
    if(NOT emit MATCHES "^(object|c)$")
        message(FATAL_ERROR "haptel_add_textures: expected EMIT object or c, found ${emit}")
    endif()
    if(NOT ARG_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "haptel_add_textures: expected texture files behind ${target}, found none")
    endif()
    if(TARGET haptel_tools) # of a build of Haptel itself: no other program has this name
        set(command haptel)
    else()
        find_program(HAPTEL_COMMAND haptel REQUIRED)
        set(command ${HAPTEL_COMMAND})
    endif()
    set(options)
    if(ARG_ISA)
        list(JOIN ARG_ISA "," isas)
        list(APPEND options --isa ${isas})
    endif()
    if(ARG_PRECISION)
        list(APPEND options --precision ${ARG_PRECISION})
    endif()
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/textures_of_${target})
    file(MAKE_DIRECTORY ${folder})
    foreach(file IN LISTS ARG_UNPARSED_ARGUMENTS)
        get_filename_component(path ${file} ABSOLUTE)
        get_filename_component(name ${file} NAME_WE)
        if(emit STREQUAL "c")
            set(code ${folder}/${name}.c)
        else()
            set(code ${folder}/${name}${CMAKE_C_OUTPUT_EXTENSION})
        endif()
        add_custom_command(
            OUTPUT ${code} ${folder}/${name}.h
            COMMAND ${command} build ${path} --emit ${emit} ${options} -o ${code} --depfile ${code}.d
            COMMAND ${command} build ${path} --emit header -o ${folder}/${name}.h
            DEPENDS ${command} ${path}
            DEPFILE ${code}.d
            COMMENT "Textures of ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${code} ${folder}/${name}.h)
        if(emit STREQUAL "c")
            # Each operation is rounded once, as everywhere.
            set_source_files_properties(${code} PROPERTIES COMPILE_OPTIONS "-ffp-contract=off")
        else()
            set_source_files_properties(${code} PROPERTIES EXTERNAL_OBJECT TRUE)
        endif()
    endforeach()
    target_include_directories(${target} PRIVATE ${folder})
    target_link_libraries(${target} PRIVATE m)
endfunction()
