{# The constants of a model, its own functions for what is wrapped, and the two that are
   called from outside. #}
{% macro inside(part) %}
{# Hysteresis that is wrapped, or what wraps it. #}
{% set own, inner = model.name ~ "_" ~ part.label, part.inner %}
{% if inner and part.step.undoes %}
{# Looks for the input of what is inside: another function tries an input, and puts back
   all that is remembered inside. #}
{% set tried = model.name ~ "_" ~ inner.label %}
{% set growth = ", s->" ~ part.label ~ "_pace[3]" if inner.step.grows else "" %}
static double @own@_output(void *model, double v)
{
    @model.name@_state *s = model;
{% for key in inner.states_inside %}
    double @key@[sizeof s->@key@ / sizeof(double)];
{% endfor %}
{% for key in inner.states_inside %}
    memcpy(@key@, s->@key@, sizeof s->@key@);
{% endfor %}
    const double y = @tried@(s, v@growth@);
{% for key in inner.states_inside %}
    memcpy(s->@key@, @key@, sizeof s->@key@);
{% endfor %}
    return y;
}

static double @own@(@model.name@_state *s, double v)
{
    const double found = @call(part, [own ~ "_output", "s", "v"])@;
    @tried@(s, found@growth@);
    return found;
}

{% else %}
static double @own@(@model.name@_state *s, double @part.takes | join(", double ")@)
{
{% if inner and part.step.drives %}
    double vs[@part.step.drives@], growths[@part.step.drives@], y = 0;
    const int count = @call(part, part.takes + ["vs", "growths"])@;
    for (int i = 0; i < count; i++) y = @own_call(inner, inner.each)@;
    return y;
{% elif inner %}
{# What is inside is called once. #}
    return @own_call(inner, inner.takes)@ + @call(part, part.takes)@;
{% else %}
    return @call(part, part.takes)@;
{% endif %}
}

{% endif %}
{% endmacro %}
{% for name, values in arrays.items() %}
@array(name, values)@

{% endfor %}
{% for piece in model.pieces if piece.inner %}
{% for part in piece.all_inside() %}
@inside(part)@
{%- endfor %}
{% endfor %}
void @model.name@_init(@model.name@_state *s)
{
    memset(s, 0, sizeof *s);
{% for state in model.starts %}
    memcpy(s->@state@, @model.name@_@state@_start, sizeof s->@state@);
{% endfor %}
}

double @model.name@_step(@model.name@_state *s, double input)
{
    double y = input;
{% if not model.all_states() | list %}
    (void)s;
{% endif %}
{% for piece in model.watching %}
    hb_remember(@piece.step.constants.points@, s->@piece.history@, input);
{% endfor %}
{% if model.sampling.delay %}
    const double call = *s->calls;
    if (call < @model.sampling.delay@) *s->calls += 1;
{% endif %}
{% for piece in model.pieces %}
{% set given = ["y", "1"] if piece.step.grows else ["y"] %}
    y = @own_call(piece, given) if piece.inner else call(piece, given)@;
{% if piece.wait %}
    if (call < @piece.wait@) return 0; /* none yet */
{% endif %}
{% endfor %}
    return y;
}
