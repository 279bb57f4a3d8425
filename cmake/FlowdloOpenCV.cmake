# OpenCV, for the lab, the benchmarks and the tests; the library and the command have nothing of it:
# opencv_core and opencv_imgproc, OpenCV_LIBS and OpenCV_INCLUDE_DIRS, and flowdlo_opencv, which is all of
# these and the headers of lab/mat, which join them with engine/image. Its own configuration comes with 300
# packages on a bare Debian; the headers and the libraries come without. Tests and the lab's reports also link
# opencv_imgcodecs. Where neither these nor the benchmarks are built, flowdlo_opencv is left behind only where
# OpenCV is: flowdlo-lab comes with it.
set(libraries core imgproc)
set(more)
set(required)
if(FLOWDLO_BUILD_LAB OR FLOWDLO_BUILD_TESTS)
  list(APPEND libraries imgcodecs)
  set(more OPTIONAL_COMPONENTS calib3d)
endif()
if(FLOWDLO_BUILD_LAB OR FLOWDLO_BUILD_TESTS OR FLOWDLO_BUILD_BENCHMARKS)
  set(required REQUIRED)
endif()
find_package(OpenCV 4.5 QUIET COMPONENTS ${libraries} ${more})
set(OpenCV_LIBS opencv_core opencv_imgproc)
if(NOT OpenCV_FOUND)
  find_path(FLOWDLO_OPENCV_INCLUDE_DIR opencv2/imgproc.hpp ${required} PATH_SUFFIXES opencv4
            DOC "Folder of opencv2/; Debian and Ubuntu: libopencv-core-dev, libopencv-imgproc-dev")
  mark_as_advanced(FLOWDLO_OPENCV_INCLUDE_DIR)
  set(OpenCV_INCLUDE_DIRS "${FLOWDLO_OPENCV_INCLUDE_DIR}")
  set(found "${FLOWDLO_OPENCV_INCLUDE_DIR}")
  list(TRANSFORM libraries PREPEND opencv_)
  foreach(library IN LISTS libraries)
    find_library(FLOWDLO_${library} ${library} ${required})
    mark_as_advanced(FLOWDLO_${library})
    if(NOT FLOWDLO_${library})
      set(found FALSE)
    endif()
  endforeach()
  if(NOT found)
    message(STATUS "flowdlo-lab (flowdlo eval, flowdlo synth) is left out: OpenCV was not found; install "
                   "libopencv-core-dev and libopencv-imgproc-dev")
    return()
  endif()
  foreach(library IN LISTS libraries)
    add_library(${library} UNKNOWN IMPORTED)
    set_target_properties(${library} PROPERTIES IMPORTED_LOCATION "${FLOWDLO_${library}}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIRS}")
  endforeach()
endif()

add_library(flowdlo_opencv INTERFACE)
target_include_directories(flowdlo_opencv INTERFACE "${PROJECT_SOURCE_DIR}/lab")
target_include_directories(flowdlo_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(flowdlo_opencv INTERFACE ${OpenCV_LIBS})
