# What the calls in reference.py share, and how they are answered: one line of numbers per call and data set.

suppressMessages({
  library(coin); library(exactRankTests); library(effectsize); library(psych); library(boot)
  library(geepack); library(lmerTest); library(ordinal); library(BayesFactor)
})
items <- c("joy", "fear", "anger", "shame")

there <- function(x) x[!is.na(x)]
pairs <- function(x, y) {
  k <- !is.na(x) & !is.na(y)
  list(x = x[k], y = y[k], d = x[k] - y[k])
}
rows <- function(d, columns = items) {
  m <- as.matrix(d[columns])
  m[complete.cases(m), , drop = FALSE]
}
long <- function(d, columns, x) {
  s <- data.frame(p = rep(seq_len(nrow(d)), each = length(columns)),
                  y = as.vector(t(as.matrix(d[columns]))), x = rep(x, nrow(d)))
  s[!is.na(s$y), ]
}
shown <- function(d) {
  s <- data.frame(p = factor(rep(seq_len(nrow(d)), 4)), s = factor(rep(1:4, each = nrow(d))),
                  y = unlist(d[items]), place = unlist(d[paste0("place_", items)]))
  s <- s[order(s$p, s$place), ]
  s$before <- factor(c(NA, head(as.integer(s$s), -1)))
  s$before[s$place == 1] <- NA
  s[!is.na(s$y), ]
}

test <- function(t) c(t$statistic, t$parameter, t$p.value)
ncp <- function(t, scale) sapply(c(.975, .025), function(p) {
  around <- t$statistic + c(-1, 1) * (3.5 + .2 * abs(t$statistic))
  uniroot(function(n) pt(t$statistic, t$parameter, n) - p, around, tol = 1e-13)$root
}) * scale
J <- function(df) exp(lgamma(df / 2) - log(sqrt(df / 2)) - lgamma((df - 1) / 2))
wilson <- function(x) prop.test(sum(x), length(x), correct = FALSE)$conf.int
counts <- function(x, y) rbind(table(factor(x, 1:0)), table(factor(y, 1:0)))

kalpha <- function(m, metric) {  # Krippendorff (2011), by pairs of raters
  m <- m[, colSums(!is.na(m)) > 1, drop = FALSE]
  v <- sort(unique(there(c(m))))
  o <- matrix(0, length(v), length(v))
  for (u in seq_len(ncol(m))) {
    r <- match(there(m[, u]), v)
    for (i in seq_along(r)) for (j in seq_along(r))
      if (i != j) o[r[i], r[j]] <- o[r[i], r[j]] + 1 / (length(r) - 1)
  }
  n <- rowSums(o)
  at <- if (metric == "interval") v else cumsum(n) - n / 2
  dd <- if (metric == "nominal") 1 - diag(length(v)) else outer(at, at, "-")^2
  1 - (sum(n) - 1) * sum(o * dd) / sum(outer(n, n) * dd)
}
hits <- function(d, columns = items) {
  m <- rows(d, columns)
  top <- m == apply(m, 1, max)
  colSums(top / rowSums(top))
}
shuffled <- function(m, target) {  # P(sum of the target), each row's ratings in any order
  chance <- 1
  for (i in seq_len(nrow(m))) {
    step <- tabulate(m[i, ] - min(m[i, ]) + 1) / ncol(m)
    grown <- numeric(length(chance) + length(step) - 1)
    for (k in seq_along(step)) {
      at <- k - 1 + seq_along(chance)
      grown[at] <- grown[at] + chance * step[k]
    }
    chance <- grown
  }
  sum(chance[(sum(m[, target] - apply(m, 1, min)) + 1):length(chance)])
}
mancl <- function(g) {  # standard errors of a geeglm after Mancl & DeRouen (2001), by their matrices
  terms <- lapply(split(seq_along(g$y), g$id), function(k) {
    mean <- fitted(g)[k]
    within <- matrix(g$geese$alpha, length(k), length(k))
    diag(within) <- 1
    v <- sqrt(mean * (1 - mean))
    list(D = v^2 * model.matrix(g)[k, , drop = FALSE], W = solve(within * outer(v, v)), e = g$y[k] - mean)
  })
  total <- function(f) Reduce(`+`, lapply(terms, f))
  bread <- solve(total(function(i) t(i$D) %*% i$W %*% i$D))
  filling <- total(function(i) {
    own <- solve(diag(length(i$e)) - i$D %*% bread %*% t(i$D) %*% i$W, i$e)
    tcrossprod(t(i$D) %*% i$W %*% own)
  })
  sqrt(diag(bread %*% filling %*% bread))
}
bca <- function(x) {  # on resamples that can be drawn elsewhere too
  u <- sin(outer(1:999 * 78.233, seq_along(x) * 12.9898, "+")) * 43758.5453
  average <- function(x, i) mean(x[i])
  b <- boot(x, average, 999)
  b$t <- cbind(rowMeans(matrix(x[floor(length(x) * (u - floor(u))) + 1], 999)))
  boot.ci(b, type = "bca", L = empinf(data = x, statistic = average, stype = "i", type = "jack"))$bca[4:5]
}

given <- commandArgs(trailingOnly = TRUE)  # the file of calls, then the data sets
calls <- readLines(given[1])
for (file in given[-1]) {
  d <- read.csv(file)
  if (grepl("excluded", file)) d <- d[d$kept == 1, ]
  for (call in calls) {
    found <- suppressWarnings(tryCatch(
      as.numeric(eval(parse(text = call), c(as.list(d), list(d = d)), globalenv())),
      error = function(e) { message(basename(file), ": ", call, ": ", conditionMessage(e)); NULL }
    ))
    cat(if (is.null(found) || any(is.nan(found))) "NULL" else sprintf("%.17g", found), "\n")
  }
}
