/* What the versions of FMI differ in by names alone. */
static @fmi@Status done(const Instance *self, const char *wrong)
{
    return wrong ? refuse(self, wrong) : @fmi@OK;
}

@fmi@Status @fmi@Reset(@fmi@@instance@ c)
{
    Instance *self = c;
    begin(&self->now);
    return @fmi@OK;
}

@fmi@Status @fmi@GetFMU@state@(@fmi@@instance@ c, @fmi@FMU@state@ *FMU@state@)
{
    const Instance *self = c;
    return done(self, keep(&self->now, FMU@state@));
}

@fmi@Status @fmi@SetFMU@state@(@fmi@@instance@ c, @fmi@FMU@state@ FMU@state@)
{
    Instance *self = c;
    memcpy(&self->now, FMU@state@, sizeof(Values));
    return @fmi@OK;
}

@fmi@Status @fmi@FreeFMU@state@(@fmi@@instance@ c, @fmi@FMU@state@ *FMU@state@)
{
    free(*FMU@state@);
    *FMU@state@ = NULL;
    return @fmi@OK;
}
