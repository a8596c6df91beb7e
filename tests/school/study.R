# The figures in study_test.cpp that come from R 4.2.2 with MASS, psych and lme4 (Debian 12: r-base-core r-cran-mass
# r-cran-psych r-cran-lme4). Not run by the tests: Rscript tests/school/study.R prints them again.
options(digits = 12)
library(MASS)
library(psych)
library(lme4)

cat("Brennan, table 2.2\n")
x <- matrix(as.integer(strsplit(paste0("101000000000", "111001000000", "111110000000", "110110010000", "111110100000",
  "111011100000", "111111100000", "111101111100", "111111111110", "111111111111"), "")[[1]]), 10, 12, byrow = TRUE)
d <- data.frame(y = c(x), p = factor(rep(1:10, 12)), i = factor(rep(1:12, each = 10)))
print(anova(aov(y ~ p + i, d)))

cat("Gleser and others, table 3\n")
data(Gleser)
g <- data.frame(stack(Gleser), P = factor(rep(1:12, 12)), I = factor(rep(1:6, each = 24)),
  J = factor(rep(rep(1:2, each = 12), 6)))
print(anova(aov(values ~ P + I + P:I + I:J, g)))
print(VarCorr(lmer(values ~ 1 + (1 | P) + (1 | I) + (1 | P:I) + (1 | I:J), g)), comp = "Variance")

cat("kappa, ICC\n")
for (table in list(c(40, 6, 9, 45), c(80, 5, 10, 5), c(118, 2, 5, 0))) print(cohen.kappa(matrix(table, 2))$kappa)
print(ICC(matrix(c(9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7), 6, 4, byrow = TRUE),
  lmer = FALSE)$results[2, "ICC"])

cat("contrasting groups\n")
low <- c(41, 48, 52, 55, 57, 60, 61, 63, 66, 70)
high <- c(66, 70, 72, 74, 75, 78, 79, 80, 81, 85, 88)
apart <- function(x) dnorm(x, mean(low), sd(low)) - dnorm(x, mean(high), sd(high))
cut <- uniroot(apart, c(mean(low), mean(high)), tol = 1e-13)$root
print(c(cut, 1 - pnorm(cut, mean(low), sd(low)), pnorm(cut, mean(high), sd(high))))

cat("curves\n")
n <- 1:9
y <- c(41, 55, 62, 64, 30, 70, 69, 73, 71)
print(coef(rlm(y ~ I(-1 / n), psi = psi.huber, scale.est = "MAD", acc = 1e-13, maxit = 1000)))
bone <- factor(c(1, 1, 2, 1, 2, 2, 1, 2, 1))
print(coef(rlm(y ~ I(-1 / n) + bone, psi = psi.huber, scale.est = "MAD", acc = 1e-13, maxit = 1000)))
n <- 1:12
y <- c(30.75, 43.45, 52.87, 60.24, 64.82, 67.22, 70.25, 71.01, 72.09, 73.65, 74.18, 73.75)
fit <- nls(y ~ a - b * exp(-c * n), start = list(a = 75, b = 60, c = 0.3))
print(coef(fit))
k <- 4
print(12 * log(sum(resid(fit)^2) / 12) + 2 * k + 2 * k * (k + 1) / (12 - k - 1))
