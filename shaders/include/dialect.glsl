// The dialect of shaders/shared/ as GLSL (shaders/shared/README.md).
#define real float
#define FN
#define INOUT(T) inout T
#define PRECISE precise
#define SPLITTER 4097.0
#define PARALLEL_LIMIT 1e-12
#define LARGEST 1e30
