"""`python -m pitchpoint` is the command."""

from pitchpoint.cli import command

if __name__ == "__main__":
    command()
