# For developers, through the presets: compile through ccache where it is installed. Paths below the source folder
# count as relative, so that clones of the project in different folders share what was compiled.
find_program(INSYM_CCACHE ccache)
if(INSYM_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}"
      CCACHE_NOHASHDIR=true ${INSYM_CCACHE})
endif()
