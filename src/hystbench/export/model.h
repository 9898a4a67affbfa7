@told@
#ifndef HB_@NAME@_H
#define HB_@NAME@_H

#define @NAME@_DT @dt@ /* s */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
@states@
} @name@_state;

@begins@
void @name@_init(@name@_state *state);

@next@
double @name@_step(@name@_state *state, double input);

#ifdef __cplusplus
}
#endif

#endif
