# Read by cpack before it makes packages: without these it would leave out what they depend on, and go on.
foreach(program dpkg-shlibdeps file)
    find_program(found_${program} ${program})
    if(NOT found_${program})
        message(FATAL_ERROR "${program} is missing: apt-get install dpkg-dev file")
    endif()
endforeach()
