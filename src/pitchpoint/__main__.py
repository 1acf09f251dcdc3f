"""`python -m pitchpoint` is the command."""

from pitchpoint.cli import main

if __name__ == "__main__":
    main()
