// Everything that a function calls is compiled into it.
#pragma once

// Sanitizers check every access of it: flattened step loops would take them minutes each to
// compile.
#ifdef __SANITIZE_ADDRESS__
#define GRAINFIELD_FLATTEN
#else
#define GRAINFIELD_FLATTEN [[gnu::flatten]]
#endif
