"""Results as labelled datasets: conventions, and files that are whole or absent."""
