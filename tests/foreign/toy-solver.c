/* A toy of somebody else's solver, for the tests of attached solvers: Terzaghi's column by finite differences and
 * backward Euler.
 *
 *     toy-solver CASE.json OUT MODE [CELLS]
 *
 * MODE is how it behaves, on CELLS cells only where they are given: right, abort, hang, nan, no-file, half, skip,
 * fail, garbage, soft (permeability too large by 1 %).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOST 4096

static char text[1 << 20];

/* The number behind the first key of a name, or the list. */
static const char *behind(const char *key) {
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *found = strstr(text, quoted);
    if (!found) {
        fprintf(stderr, "the case has no %s\n", key);
        exit(2);
    }
    return found + strlen(quoted);
}

static double number(const char *key) { return strtod(behind(key), NULL); }

static int numbers(const char *key, double *list) {
    const char *at = strchr(behind(key), '[') + 1;
    int count = 0;
    for (;;) {
        char *end;
        double value = strtod(at, &end);
        if (end == at || count == MOST) return count;
        list[count++] = value;
        at = end + strspn(end, ", \n");
    }
}

/* One step by Thomas's algorithm: mirrored at the base (node 0), drained at the surface (node `cells`). */
static void step(double *p, int cells, double ratio) {
    double upper[MOST], right[MOST];
    for (int i = 0; i < cells; i++) {
        double over = i == 0 ? -2 * ratio : -ratio;
        double pivot = 1 + 2 * ratio + (i == 0 ? 0 : ratio * upper[i - 1]);
        upper[i] = over / pivot;
        right[i] = (p[i] + (i == 0 ? 0 : ratio * right[i - 1])) / pivot;
    }
    p[cells] = 0;
    for (int i = cells - 1; i >= 0; i--) p[i] = right[i] - upper[i] * p[i + 1];
}

int main(int count, char **arguments) {
    if (count == 2 && !strcmp(arguments[1], "--version")) {
        puts("toy-solver 1.2");
        return 0;
    }
    if (count < 4) return 2;
    FILE *file = fopen(arguments[1], "r");
    if (!file) return 2;
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    int cells = (int)number("cells");
    const char *mode = count < 5 || atoi(arguments[4]) == cells ? arguments[3] : "right";
    int is = 0;
#define MODE(word) (is = !strcmp(mode, word))
    if (MODE("abort")) abort();
    if (MODE("hang")) {
        fputs("still at it\n", stderr);
        for (;;) sleep(60);
    }
    if (MODE("skip")) {
        fputs("the library that I need is not here\n", stderr);
        return 77;
    }
    if (MODE("fail")) {
        fputs("matrix is singular in row 7\n", stderr);
        return 3;
    }
    double height = number("height"), load = number("load"), conductivity = number("hydraulic_conductivity");
    double modulus = number("oedometric_modulus"), weight = number("unit_weight_of_water");
    double storage = number("porosity") / number("water_bulk_modulus");
    if (MODE("soft")) conductivity *= 1.01;
    double times[MOST], p[MOST], h = height / cells, time = 0;
    int outputs = numbers("times", times);
    double diffusivity = conductivity / (weight * (1 / modulus + storage));
    for (int i = 0; i <= cells; i++) p[i] = i == cells ? 0 : load / (1 + modulus * storage);
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", arguments[2], MODE("no-file") ? "elsewhere.csv" : "result.csv");
    file = fopen(path, "w");
    if (!file) return 2;
    fputs(MODE("garbage") ? "\"t,y\n" : "t,y,p,u_y\n", file);
    for (int output = 0; output < outputs; output++) {
        int steps = (int)ceil((times[output] - time) / number("time_step") - 1e-9);
        double dt = steps > 0 ? (times[output] - time) / steps : 0;
        for (int i = 0; i < steps; i++) step(p, cells, diffusivity * dt / (h * h));
        time = times[output];
        double u = 0;
        for (int i = 0; i <= cells; i++) {
            if (i > 0) u -= h * (load - 0.5 * (p[i] + p[i - 1])) / modulus;
            if (MODE("half") && i > cells / 2) continue;
            if (MODE("nan") && i == 1) fprintf(file, "%.17g,%.17g,nan,%.17g\n", time, i * h, u);
            else fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", time, i * h, p[i], u);
        }
    }
    fclose(file);
    (void)is;
    printf("It took %g s\n", 0.125);
    return 0;
}
