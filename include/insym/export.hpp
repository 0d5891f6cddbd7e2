// Marks what a shared library shows to its users; everything else stays inside it.
#pragma once

#if defined(__GNUC__)
#define INSYM_EXPORT __attribute__((visibility("default")))
#else
#define INSYM_EXPORT
#endif
