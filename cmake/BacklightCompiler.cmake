# Compiler settings that every target shares.
#
# -ffp-contract=off: a*b+c is two roundings on every machine, so that images have the same bits everywhere.
# -fno-math-errno, -fno-trapping-math: change no result; they let sqrt and selects stay instructions.
add_library(backlight_compiler INTERFACE)
target_compile_features(backlight_compiler INTERFACE cxx_std_20)
target_compile_options(backlight_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
  -Wno-missing-field-initializers  # what a designated initialiser leaves out has a default, on purpose
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
# gcc 12 warns falsely about std::string's own operator+ (GCC bug 105651).
target_compile_options(backlight_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

if(BACKLIGHT_SANITIZE STREQUAL "address")
  target_compile_options(backlight_compiler INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(backlight_compiler INTERFACE -fsanitize=address,undefined)
  # With a sanitizer gcc 12 believes std::function's members, inside <regex>, to be uninitialised (GCC bug 105562).
  target_compile_options(backlight_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
elseif(BACKLIGHT_SANITIZE STREQUAL "thread")
  target_compile_options(backlight_compiler INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(backlight_compiler INTERFACE -fsanitize=thread)
elseif(BACKLIGHT_SANITIZE)
  message(FATAL_ERROR "BACKLIGHT_SANITIZE is '${BACKLIGHT_SANITIZE}'; expected address, thread or nothing")
endif()

if(BACKLIGHT_SANITIZE)
  target_sources(backlight_compiler INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${CMAKE_CURRENT_LIST_DIR}/sanitizer_hooks.cpp>)
endif()

# Options of files whose kernels are for wider registers than every machine has. They are optimised in every kind of build, so
# that nothing of them is left as a function of its own that the linker might give to other files. gcc 12 believes a register that its own
# intrinsics leave undefined on purpose to be uninitialised (GCC bug 105593).
set(BACKLIGHT_AVX2 -O2)
set(BACKLIGHT_AVX512 -O2)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND BACKLIGHT_AVX2 -mavx2)
  list(APPEND BACKLIGHT_AVX512 -mavx512f -mavx512dq -mavx512vl
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>)
endif()

# NAME_avx2.cpp and NAME_avx512.cpp of this folder, which other processors leave out.
function(backlight_wide_kernels name)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set_source_files_properties(${name}_avx2.cpp PROPERTIES COMPILE_OPTIONS "${BACKLIGHT_AVX2}")
    set_source_files_properties(${name}_avx512.cpp PROPERTIES COMPILE_OPTIONS "${BACKLIGHT_AVX512}")
  else()
    set_source_files_properties(${name}_avx2.cpp ${name}_avx512.cpp PROPERTIES HEADER_FILE_ONLY ON)
  endif()
endfunction()
