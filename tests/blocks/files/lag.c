/* A lag of first order, tau = 2 ms, and a gain of 3: a unit of FMI 2 for
   co-simulation, by its specification alone. Input 1, output 2, parameter 3. */
#include <stdlib.h>
#include <string.h>
typedef void *C; typedef unsigned V; typedef double R; typedef int B; typedef int S;
typedef const char *T;
typedef struct { double u, y, gain; } Lag;
#define NO(name, ...) S name(__VA_ARGS__) { return 3; }
T fmi2GetTypesPlatform(void) { return "default"; }
T fmi2GetVersion(void) { return "2.0"; }
C fmi2Instantiate(T n, int t, T g, T r, const void *f, B v, B l) {
    Lag *lag = calloc(1, sizeof *lag); lag->gain = 3; return lag; }
void fmi2FreeInstance(C c) { free(c); }
S fmi2SetDebugLogging(C c, B l, size_t n, const T s[]) { return 0; }
S fmi2SetupExperiment(C c, B d, R tol, R start, B e, R stop) { return 0; }
S fmi2EnterInitializationMode(C c) { return 0; }
S fmi2ExitInitializationMode(C c) { return 0; }
S fmi2Terminate(C c) { return 0; }
S fmi2Reset(C c) { memset(c, 0, sizeof(Lag)); ((Lag *)c)->gain = 3; return 0; }
S fmi2GetReal(C c, const V r[], size_t n, R x[]) {
    for (size_t k = 0; k < n; k++) x[k] = ((double *)c)[r[k] - 1]; return 0; }
S fmi2SetReal(C c, const V r[], size_t n, const R x[]) {
    for (size_t k = 0; k < n; k++) ((double *)c)[r[k] - 1] = x[k]; return 0; }
S fmi2DoStep(C c, R t, R h, B p) {
    Lag *lag = c; double steps = 1000;
    for (int k = 0; k < steps; k++)
        lag->y += h / steps / 0.002 * (lag->gain * lag->u - lag->y);
    return 0; }
NO(fmi2GetInteger, C c, const V r[], size_t n, int x[])
NO(fmi2GetBoolean, C c, const V r[], size_t n, B x[])
NO(fmi2GetString, C c, const V r[], size_t n, T x[])
NO(fmi2SetInteger, C c, const V r[], size_t n, const int x[])
NO(fmi2SetBoolean, C c, const V r[], size_t n, const B x[])
NO(fmi2SetString, C c, const V r[], size_t n, const T x[])
NO(fmi2GetFMUstate, C c, C *s)
NO(fmi2SetFMUstate, C c, C s)
NO(fmi2FreeFMUstate, C c, C *s)
NO(fmi2SerializedFMUstateSize, C c, C s, size_t *n)
NO(fmi2SerializeFMUstate, C c, C s, char b[], size_t n)
NO(fmi2DeSerializeFMUstate, C c, const char b[], size_t n, C *s)
NO(fmi2GetDirectionalDerivative, C c, const V u[], size_t n, const V k[], size_t m,
   const R d[], R x[])
NO(fmi2SetRealInputDerivatives, C c, const V r[], size_t n, const int o[], const R x[])
NO(fmi2GetRealOutputDerivatives, C c, const V r[], size_t n, const int o[], R x[])
NO(fmi2CancelStep, C c)
NO(fmi2GetStatus, C c, int k, S *x)
NO(fmi2GetRealStatus, C c, int k, R *x)
NO(fmi2GetIntegerStatus, C c, int k, int *x)
NO(fmi2GetBooleanStatus, C c, int k, B *x)
NO(fmi2GetStringStatus, C c, int k, T *x)
