/* A drive as a unit of FMI 2.0 for co-simulation: what every unit answers.
 *
 * C99; loss_table.h beside it holds the loss map, joint_of.h the numbers of the drive: JOINT_LAW is the number of
 * the friction law, JOINT_GUID that of modelDescription.xml, JOINT_TEMPERATURE the one that holds until another is
 * set. joint_map.h gives loss and torque at once, joint_motion.h moves rotor and load, where JOINT_MOVES. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "loss_table.h"
#include "joint_of.h"

#if defined(_WIN32)
#define FMI2_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define FMI2_EXPORT __attribute__((visibility("default")))
#else
#define FMI2_EXPORT
#endif

/* Types of fmi2TypesPlatform.h, "default", and of fmi2FunctionTypes.h. */
typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

#if defined(JOINT_MOVES)
#include "joint_motion.h"
#else
#include "joint_map.h"
#endif

FMI2_EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

FMI2_EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

FMI2_EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[])
{
    (void)c, (void)on, (void)n, (void)names;
    return fmi2OK;
}

FMI2_EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                                          fmi2Boolean logging)
{
    struct joint *joint = NULL;
    (void)name, (void)resources, (void)functions, (void)visible, (void)logging;
    if (type == fmi2CoSimulation && guid && strcmp(guid, JOINT_GUID) == 0)
        joint = malloc(sizeof *joint);
    if (joint)
        joint_reset(joint);
    return joint;
}

FMI2_EXPORT void fmi2FreeInstance(fmi2Component c)
{
    free(c);
}

FMI2_EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerant, fmi2Real tolerance,
                                           fmi2Real start, fmi2Boolean ends, fmi2Real stop)
{
    (void)tolerant, (void)tolerance, (void)ends, (void)stop;
    ((struct joint *)c)->time = start;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return joint_start(c) ? fmi2OK : fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2Terminate(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    joint_reset(c);
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                   fmi2Real values[])
{
    for (size_t k = 0; k < n; ++k) {
        if (numbers[k] >= REALS)
            return fmi2Error;
        values[k] = joint_output(c, numbers[k]);
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                      fmi2Boolean values[])
{
    for (size_t k = 0; k < n; ++k) {
        if (numbers[k] < REALS || numbers[k] >= ALL)
            return fmi2Error;
        values[k] = joint_output(c, numbers[k]) != 0.0;
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                      fmi2Integer values[])
{
    (void)c, (void)numbers, (void)values;
    return n ? fmi2Error : fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                     fmi2String values[])
{
    (void)c, (void)numbers, (void)values;
    return n ? fmi2Error : fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                   const fmi2Real values[])
{
    for (size_t k = 0; k < n; ++k) {
        if (!joint_set(c, numbers[k], values[k]))
            return fmi2Error;
    }
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                      const fmi2Integer values[])
{
    (void)c, (void)numbers, (void)values;
    return n ? fmi2Error : fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                      const fmi2Boolean values[])
{
    (void)c, (void)numbers, (void)values;
    return n ? fmi2Error : fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                     const fmi2String values[])
{
    (void)c, (void)numbers, (void)values;
    return n ? fmi2Error : fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    if (!*state)
        *state = malloc(sizeof(struct joint));
    if (!*state)
        return fmi2Error;
    memcpy(*state, c, sizeof(struct joint));
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    memcpy(c, state, sizeof(struct joint));
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(struct joint);
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    (void)c;
    if (size < sizeof(struct joint))
        return fmi2Error;
    memcpy(bytes, state, sizeof(struct joint));
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                               fmi2FMUstate *state)
{
    if (size < sizeof(struct joint) || fmi2GetFMUstate(c, state) != fmi2OK)
        return fmi2Error;
    memcpy(*state, bytes, sizeof(struct joint));
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference of[], size_t n,
                                                    const fmi2ValueReference by[], size_t m,
                                                    const fmi2Real along[], fmi2Real found[])
{
    (void)c, (void)of, (void)n, (void)by, (void)m, (void)along, (void)found;
    return fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference numbers[], size_t n,
                                                   const fmi2Integer order[], const fmi2Real values[])
{
    (void)c, (void)numbers, (void)n, (void)order, (void)values;
    return fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference numbers[],
                                                    size_t n, const fmi2Integer order[], fmi2Real values[])
{
    (void)c, (void)numbers, (void)n, (void)order, (void)values;
    return fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean final)
{
    (void)time, (void)final;
    return joint_step(c, step) ? fmi2OK : fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2CancelStep(fmi2Component c)
{
    (void)c;
    return fmi2Error;
}

FMI2_EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

FMI2_EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime)
        return fmi2Discard;
    *value = ((struct joint *)c)->time;
    return fmi2OK;
}

FMI2_EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

FMI2_EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}

FMI2_EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)c, (void)kind, (void)value;
    return fmi2Discard;
}
