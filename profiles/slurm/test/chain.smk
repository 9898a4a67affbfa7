# Three jobs that do nothing, one after the other: what a level of the job graph costs.
rule all:
    input:
        "3.txt",


rule first:
    output:
        "1.txt",
    shell:
        "touch {output}"


rule second:
    input:
        "1.txt",
    output:
        "2.txt",
    shell:
        "touch {output}"


rule third:
    input:
        "2.txt",
    output:
        "3.txt",
    shell:
        "touch {output}"
