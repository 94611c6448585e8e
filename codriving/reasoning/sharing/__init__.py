"""State and intent sharing: what each CAV knows of the other vehicles (classes A and B of SAE J3216)."""
