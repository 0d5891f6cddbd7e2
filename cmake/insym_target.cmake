# What every target of the project has in common: language level, warnings, sanitizers.
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# A shared library shows only what a public header marks INSYM_EXPORT.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
# The installed program finds it beside itself, wherever the two are moved together.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

function(insym_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(INSYM_WARNINGS_AS_ERRORS)
    # GCC 12 wrongly sees an overlap in "literal" + std::string (GCC's bug 105651).
    target_compile_options(${name} PRIVATE -Werror -Wno-restrict)
  endif()
  # Nothing reads errno, and a loop of square roots that sets it cannot take several at once.
  target_compile_options(${name} PRIVATE -fno-math-errno)
  # Same bytes everywhere: no contraction of a*b+c, which depends on the machine.
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  if(INSYM_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=${INSYM_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${name} PUBLIC -fsanitize=${INSYM_SANITIZE})
    target_compile_options(${name} PRIVATE -fno-sanitize-recover=all)
  endif()
  # Shared libraries: until 1.0 a new minor version may change the binary interface.
  get_target_property(type ${name} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION}
      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
endfunction()

# insym_reach_inside(NAME): for tests and benchmarks that call what a shared insym hides. They get its objects.
function(insym_reach_inside name)
  if(BUILD_SHARED_LIBS)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:insym>)
    target_link_libraries(${name} PRIVATE TBB::tbb)
  endif()
endfunction()
