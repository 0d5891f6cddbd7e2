# For developers, through the presets: compile through ccache where it is installed.
find_program(INSYM_CCACHE ccache)
if(INSYM_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${INSYM_CCACHE})
endif()
