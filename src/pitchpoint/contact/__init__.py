"""What happens at one contact: the contact type that every gear family fills, and Hertz pressure."""
