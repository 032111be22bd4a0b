# The tests that take half a minute and more, longest first. ctest starts them in this order and before all others, or a
# long one would be left running alone in the end.
set(haptel_long_tests
    command_tests jit_test runtime_test bench_tests contact_test fit_test device_tests lang_emit_c_test fit_command_tests
    materials_packed attacks lang_emit_glsl_test live_tests jit_test_baseline jit_test_avx2 surface_test
    conformance_jit_test lang_compile_test lang_text_test stdlib_test example_check lang_ir_test extremes_test
    materials_test osc_tests anchors_test api_installed ports_test devices_tests usb_tests materials_check example_test)

# haptel_start_early(test...): those of the list among them.
function(haptel_start_early)
    list(LENGTH haptel_long_tests count)
    foreach(test ${ARGN})
        list(FIND haptel_long_tests ${test} before)
        if(NOT before EQUAL -1)
            math(EXPR cost "${count} - ${before}")
            set_tests_properties(${test} PROPERTIES COST ${cost})
        endif()
    endforeach()
endfunction()
