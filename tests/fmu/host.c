/* A master in C that loads the library given as argument, moves a fairlead or a vessel for 10 s and prints an output. For the win64 library under wine:
 *     x86_64-w64-mingw32-gcc -o host.exe tests/fmu/host.c
 *     wine64 host.exe binaries/win64/moorline.dll GUID file:///.../resources POSITION VELOCITY OUTPUT
 * The last three are value references. */
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

typedef void *(*Instantiate)(const char *, int, const char *, const char *, const void *, int, int);
typedef int (*Setup)(void *, int, double, double, int, double);
typedef int (*Simple)(void *);
typedef int (*SetReal)(void *, const unsigned *, size_t, const double *);
typedef int (*GetReal)(void *, const unsigned *, size_t, double *);
typedef int (*DoStep)(void *, double, double, int);
typedef void (*Free)(void *);

static void logger(void *environment, const char *name, int status, const char *category, const char *message, ...)
{
    (void)environment;
    printf("%s, status %d, %s: %s\n", name, status, category, message);
}

int main(int argc, char **argv)
{
    struct { void (*logger)(void *, const char *, int, const char *, const char *, ...); void *rest[4]; } callbacks = {logger, {0}};
    unsigned inputs[2], output;
    double time = 0.0, value = 0.0;
    void *line;
    HMODULE library;
    if (argc != 7)
        return 2;
    inputs[0] = (unsigned)atoi(argv[4]);
    inputs[1] = (unsigned)atoi(argv[5]);
    output = (unsigned)atoi(argv[6]);
    library = LoadLibraryA(argv[1]);
    if (!library) {
        printf("cannot load %s: error %lu\n", argv[1], GetLastError());
        return 3;
    }
#define FUNCTION(type, name) ((type)(void *)GetProcAddress(library, name))
    line = FUNCTION(Instantiate, "fmi2Instantiate")("line", 1, argv[2], argv[3], &callbacks, 0, 1);
    if (!line)
        return 4;
    if (FUNCTION(Setup, "fmi2SetupExperiment")(line, 0, 0.0, 0.0, 0, 0.0) || FUNCTION(Simple, "fmi2EnterInitializationMode")(line)
        || FUNCTION(Simple, "fmi2ExitInitializationMode")(line))
        return 5;
    for (int step = 0; step < 100; step++) {
        double values[2] = {0.02 * time * time, 0.04 * time};
        if (FUNCTION(SetReal, "fmi2SetReal")(line, inputs, 2, values) || FUNCTION(DoStep, "fmi2DoStep")(line, time, 0.1, 1))
            return 6;
        time += 0.1;
    }
    if (FUNCTION(GetReal, "fmi2GetReal")(line, &output, 1, &value))
        return 7;
    FUNCTION(Free, "fmi2FreeInstance")(line);
    printf("after 10 s: %.3f N\n", value);
    return 0;
}
