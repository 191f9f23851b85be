/* A C library whose elementary functions are off by one unit in the last place in two of three results:
 * loaded before the platform's, it stands for another platform. What is off depends on the result alone. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static double off(double value)
{
    uint64_t bits;
    if (!isfinite(value) || value == 0.0)
        return value;
    memcpy(&bits, &value, sizeof bits);
    switch (bits % 3) {
    case 0: return nextafter(value, INFINITY);
    case 1: return nextafter(value, -INFINITY);
    default: return value;
    }
}

#define ONE(name)                                                            \
    double name(double x)                                                    \
    {                                                                        \
        static double (*real)(double);                                       \
        if (!real)                                                           \
            real = (double (*)(double))dlsym(RTLD_NEXT, #name);              \
        return off(real(x));                                                 \
    }
#define TWO(name)                                                            \
    double name(double x, double y)                                          \
    {                                                                        \
        static double (*real)(double, double);                               \
        if (!real)                                                           \
            real = (double (*)(double, double))dlsym(RTLD_NEXT, #name);      \
        return off(real(x, y));                                              \
    }

ONE(exp) ONE(exp2) ONE(expm1) ONE(log) ONE(log2) ONE(log10) ONE(log1p)
ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan)
ONE(sinh) ONE(cosh) ONE(tanh) ONE(asinh) ONE(acosh) ONE(atanh)
ONE(cbrt) ONE(erf) ONE(erfc) ONE(tgamma) ONE(lgamma)
TWO(pow) TWO(atan2) TWO(hypot)

void sincos(double x, double *sine, double *cosine)
{
    *sine = sin(x);
    *cosine = cos(x);
}
