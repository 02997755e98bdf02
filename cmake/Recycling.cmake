# Memory of matrices is used again in Cordon's own libraries and plugins: their calls of malloc
# and the like, which are Eigen's, are led to framework/core/include/cordon/core/recycled.hpp. Blocks are
# those of malloc, and may be freed elsewhere. Not under sanitizers, which want to see every block.
#
# cordon_recycling(target)
if(NOT CORDON_SANITIZE)
  add_library(cordon_malloc OBJECT "${PROJECT_SOURCE_DIR}/framework/core/malloc/malloc.cpp")
  target_include_directories(cordon_malloc PRIVATE
    "${PROJECT_SOURCE_DIR}/framework/core/include")
  set_target_properties(cordon_malloc PROPERTIES CXX_VISIBILITY_PRESET hidden
    POSITION_INDEPENDENT_CODE ON)
endif()

function(cordon_recycling target)
  if(TARGET cordon_malloc)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:cordon_malloc>)
    target_link_options(${target} PRIVATE LINKER:--wrap=malloc LINKER:--wrap=calloc
      LINKER:--wrap=realloc LINKER:--wrap=free LINKER:-Bsymbolic-functions)
  endif()
endfunction()
