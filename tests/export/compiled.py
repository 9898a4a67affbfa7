"""Many exported models in one C program: one compilation for all of them."""

import subprocess
from pathlib import Path

import numpy as np

from hystbench.export import code

STRICT = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"]

MAIN = """
#include <stdio.h>

#define RUN(name)                                            \\
    {                                                        \\
        static name##_state state;                           \\
        name##_init(&state);                                 \\
        for (long k = 0; k < n; k++)                         \\
            out[k] = name##_step(&state, u[k]);              \\
        fwrite(out, sizeof *out, (size_t)n, stdout);         \\
    }

int main(int count, char **arguments)
{
    static double u[100000], out[100000];
    FILE *file = fopen(count > 1 ? arguments[1] : "u", "rb");
    if (!file) return 1;
    const long n = (long)fread(u, sizeof *u, 100000, file);
    fclose(file);
    %s
    return 0;
}
"""


class Compiled:
    """Some models as one program, which runs all of them on one input."""

    def __init__(self, models, folder: Path, *flags: str) -> None:
        self.models, self.folder = models, folder
        names = [model.name for model in models]
        assert len(set(names)) == len(names)
        text = "\n\n".join(
            [
                code.library(models),
                *(code.header(model) for model in models),
                *(code.body(model) for model in models),
                MAIN % "\n    ".join(f"RUN({name})" for name in names),
            ]
        )
        (folder / "all.c").write_text(text)
        command = ["cc", *STRICT, *(flags or ["-O1"]), "all.c", "-o", "all", "-lm"]
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr[:4000]

    def outputs(self, u) -> dict[str, np.ndarray]:
        """Give the output of each model by its name."""
        np.asarray(u, dtype=np.float64).tofile(self.folder / "u")
        done = subprocess.run(
            ["./all", "u"], cwd=self.folder, capture_output=True, check=False
        )
        assert done.returncode == 0, done.stderr.decode()[:4000]
        all_of_it = np.frombuffer(done.stdout).reshape(len(self.models), len(u))
        names = [model.name for model in self.models]
        return dict(zip(names, all_of_it, strict=True))
