"""From a task to designs: what is looked for among many, by closed forms, and checked as every design is."""
