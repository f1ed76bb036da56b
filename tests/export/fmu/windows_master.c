/* A master for Windows that steps the DLL of an FMU 2.0 and writes the forces to a file: motion as
   in test_windows.py, the second half twice, from a saved state. It needs no C runtime of its own,
   which the cross-compiler would build for minutes. */

#include <math.h>
#include <stddef.h>

typedef unsigned int Reference;

void *LoadLibraryA(const char *name);
void *GetProcAddress(void *library, const char *name);
void ExitProcess(unsigned int code);
void *fopen(const char *name, const char *mode);
size_t fwrite(const void *data, size_t size, size_t count, void *file);
int fclose(void *file);

enum { HALF = 1000, ALL = 2000 };

#define FIND(type, name, ...)                                                   \
    type (*name)(__VA_ARGS__) = (type (*)(__VA_ARGS__))GetProcAddress(library, #name); \
    if (name == NULL)                                                           \
        ExitProcess(2)

void begin(void);
void begin(void)
{
    void *library = LoadLibraryA("damper.dll"), *callbacks[5] = {NULL}, *state = NULL, *c, *file;
    const Reference inputs[3] = {1, 2, 3}, force = 7;
    double u[3], f;
    int round, i;

    if (library == NULL)
        ExitProcess(1);
    FIND(void *, fmi2Instantiate, const char *, int, const char *, const char *, const void *, int,
         int);
    FIND(int, fmi2SetupExperiment, void *, int, double, double, int, double);
    FIND(int, fmi2EnterInitializationMode, void *);
    FIND(int, fmi2ExitInitializationMode, void *);
    FIND(int, fmi2SetReal, void *, const Reference *, size_t, const double *);
    FIND(int, fmi2GetReal, void *, const Reference *, size_t, double *);
    FIND(int, fmi2DoStep, void *, double, double, int);
    FIND(int, fmi2GetFMUstate, void *, void **);
    FIND(int, fmi2SetFMUstate, void *, void *);
    FIND(int, fmi2FreeFMUstate, void *, void **);
    FIND(void, fmi2FreeInstance, void *);
    c = fmi2Instantiate("one", 1, GUID, "", callbacks, 0, 0);
    file = fopen("forces.bin", "wb");
    if (c == NULL || file == NULL)
        ExitProcess(3);
    for (round = 0; round < 2; round++) {
        for (i = round == 0 ? 0 : HALF; i < ALL; i++) {
            double t = i * 1e-3;

            u[0] = 0.01 * sin(7.0 * t);
            u[1] = 0.07 * cos(7.0 * t);
            u[2] = i < HALF ? 0.1 : 0.4;
            if (round == 0 && i == HALF)
                fmi2GetFMUstate(c, &state);
            if (i == 0) {
                fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0);
                fmi2EnterInitializationMode(c);
                fmi2SetReal(c, inputs, 3, u);
                fmi2ExitInitializationMode(c);
            } else {
                fmi2SetReal(c, inputs, 3, u);
                fmi2DoStep(c, t - 1e-3, 1e-3, 1);
            }
            fmi2GetReal(c, &force, 1, &f);
            fwrite(&f, sizeof f, 1, file);
        }
        if (round == 0)
            fmi2SetFMUstate(c, state);
    }
    fclose(file);
    fmi2FreeFMUstate(c, &state);
    fmi2FreeInstance(c);
    ExitProcess(0);
}
