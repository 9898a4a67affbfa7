@comment([model.title ~ ": " ~ model.about ~ "."] + model.differences)@
#ifndef HB_@model.name | upper@_H
#define HB_@model.name | upper@_H

#define @model.name | upper@_DT @model.sampling.dt@ /* s */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
{% for state, size in states %}
    double @state@[@size@];
{% endfor %}
} @model.name@_state;

@comment([model.begins])@
void @model.name@_init(@model.name@_state *state);

@comment(["The next sample: " ~ model.output.label ~ " of " ~ model.input.label ~ "."])@
double @model.name@_step(@model.name@_state *state, double input);

#ifdef __cplusplus
}
#endif

#endif
