// Symbol visibility: the library is built with everything hidden but what carries FLOWDLO_EXPORT.
#pragma once

#if defined(_WIN32) && defined(FLOWDLO_SHARED)
#ifdef FLOWDLO_BUILDING
#define FLOWDLO_EXPORT __declspec(dllexport)
#else
#define FLOWDLO_EXPORT __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define FLOWDLO_EXPORT __attribute__((visibility("default")))
#else
#define FLOWDLO_EXPORT
#endif

/// For what would be as visible as the exported class that it is a member of.
#ifdef __GNUC__
#define FLOWDLO_HIDDEN __attribute__((visibility("hidden")))
#else
#define FLOWDLO_HIDDEN
#endif
